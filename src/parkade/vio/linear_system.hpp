// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/geometry/robust.hpp"
#include "parkade/vio/factors.hpp"
#include "parkade/vio/reprojection.hpp"
#include "parkade/vio/window.hpp"

namespace parkade {

/// Which terms of a window's cost take part.
struct FactorSelection {
  bool prior = true;
  std::vector<char> imu;    ///< per frame: readings since the frame before it
  std::vector<char> still;  ///< per frame: rest since still_since
  std::vector<char> unary;  ///< per frame: body velocity, start prior (with gravity's)
  bool calibration = true;  ///< what is known beforehand of refined cameras
  /// Of what is known beforehand of a landmark's inverse distance, m^2.
  double inverse_distance_information = kPriorInverseDistanceInformation;
  std::vector<WindowFeature*> features;

  /// Everything in the window but features.
  static FactorSelection all(const Window& window);
  static FactorSelection none(const Window& window);
};

/// What bounds the influence of single terms.
struct WindowLoss {
  RobustLoss views;  ///< of whitened reprojection errors
  /// Of biases' whitened steps: quadratic to there, like a logarithm beyond. What is known of a
  /// walk comes from seconds, so that the steps between frames stay below a hundredth of their
  /// sigma; one of a sixth is part of a jump.
  double bias_step = 0.32;
};

/// The cost of a window, squared about its present state: gradient and Gauss-Newton matrix of the
/// frames, with the landmarks apart so that they can be eliminated (docs/math/residuals.md, eq.
/// 11). The robust loss enters as weights. Frame i has rows 15 i to 15 i + 14, the window's globals
/// the last ones.
class LinearSystem {
 public:
  LinearSystem(const WindowLoss& loss, const StillSigma& still) : loss_(loss), still_(still) {}

  /// Evaluates residuals at the states and Jacobians at jacobianState(). Returns the cost.
  double linearise(const Window& window, const FactorSelection& selection);

  /// The cost at the present state with the selection last linearised.
  [[nodiscard]] double cost() const { return cost_; }
  [[nodiscard]] int numObservations() const { return num_observations_; }
  /// Of frames and globals.
  [[nodiscard]] const Eigen::VectorXd& gradient() const { return b_; }

  /// Eliminates the landmarks, with `damping` times the diagonal added to them.
  void reduce(double damping);
  /// Valid after reduce(): frames and globals, lower triangle. The prior counts as a term like
  /// others.
  [[nodiscard]] const Eigen::MatrixXd& reducedH() const { return reduced_H_; }
  [[nodiscard]] const Eigen::VectorXd& reducedB() const { return reduced_b_; }

  /// Moves the landmarks along with a step of the frames. Valid after reduce(). The gradient times
  /// the landmarks' step is added to `gradient_dot_step`.
  void applyToLandmarks(const Eigen::VectorXd& frame_step, double& gradient_dot_step);

 private:
  using Matrix63d = Eigen::Matrix<double, 6, 3>;
  struct LandmarkBlock {
    WindowFeature* feature = nullptr;
    Eigen::Matrix3d V = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d V_inverse = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    int first = 0;  ///< of its coupling blocks
    int count = 0;
    int first_camera = 0;  ///< of its coupling blocks with refined cameras
    int camera_count = 0;
  };
  struct CouplingBlock {
    int frame = 0;
    Matrix63d W = Matrix63d::Zero();  ///< pose by landmark
  };

  using CalibrationByLandmark = Eigen::Matrix<double, kCalibration, 3>;
  using PixelByCalibration = Eigen::Matrix<double, 2, kCalibration>;
  struct CameraCoupling {
    int camera = 0;
    CalibrationByLandmark W = CalibrationByLandmark::Zero();
  };

  void addPrior(const Window& window);
  void addImu(const Window& window, const FactorSelection& selection);
  void addMotion(const Window& window, const FactorSelection& selection);
  void addStart(const Window& window, const WindowFrame& frame, int index);
  void addCalibration(const Window& window);
  void addFeature(const Window& window, WindowFeature& feature, double prior_information);
  void addCameras(const CameraJacobians& cameras, const WindowObservation& observation,
                  double weight, int anchor_camera, int anchor, int target,
                  const Eigen::Vector2d& r, const ReprojectionJacobians& j,
                  LandmarkBlock& landmark);
  void reduceCameras(const LandmarkBlock& landmark, const Eigen::Vector3d& V_b);
  [[nodiscard]] Eigen::Index cameraRow(int camera) const {
    return globals_ + Window::cameraGlobal(static_cast<std::size_t>(camera));
  }
  void addPair(int i, int j, const Matrix15d& hii, const Matrix15d& hji, const Matrix15d& hjj);

  WindowLoss loss_;
  StillSigma still_;
  double cost_ = 0.0;
  int num_observations_ = 0;
  Eigen::MatrixXd H_;
  Eigen::VectorXd b_;
  Eigen::MatrixXd reduced_H_;
  Eigen::VectorXd reduced_b_;
  std::vector<LandmarkBlock> landmarks_;
  std::vector<CouplingBlock> couplings_;
  std::vector<CameraCoupling> camera_couplings_;
  Eigen::Index globals_ = 0;  ///< first row of the globals
  std::vector<PoseMatrices> poses_;
  std::vector<PoseMatrices> poses_lin_;
  std::vector<int> slot_;  ///< per frame: position of its coupling block, -1 none
};

}  // namespace parkade
