// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/geometry/se3.hpp"
#include "parkade/imu/preintegration.hpp"

namespace parkade {

inline constexpr double kLeastReadoutTime = 1e-6;  ///< s
inline constexpr int kCalibration = 8;             ///< size of a camera's tangent
using CalibrationVector = Eigen::Matrix<double, kCalibration, 1>;
using CalibrationMatrix = Eigen::Matrix<double, kCalibration, kCalibration>;

/// A camera as the estimator needs it.
struct VioCamera {
  Camera camera;
  SE3 T_imu_cam;
  double time_offset = 0.0;   ///< s; added to a stamp gives the time on the IMU's clock
  double readout_time = 0.0;  ///< s from the first row to the last (RigCamera)
};

/// A camera's readout time as others may use it: above zero with a rolling shutter, however noisy.
inline double toldReadoutTime(const VioCamera& camera) {
  return camera.readout_time < 0.0 ? kLeastReadoutTime : camera.readout_time;
}

/// What is known of a camera's calibration before any image, where it is refined online. Eight
/// degrees of freedom: position (imu axes, m), rotation (right perturbation of R_imu_cam, rad),
/// time offset (s), readout time (s).
struct CameraRefinement {
  SE3 prior_T_imu_cam;
  double prior_time_offset = 0.0;
  double prior_readout_time = 0.0;
  CalibrationVector sigma = CalibrationVector::Ones();

  bool linearised = false;
  SE3 lin_T_imu_cam;
  double lin_time_offset = 0.0;
  double lin_readout_time = 0.0;
  CalibrationVector delta = CalibrationVector::Zero();
};

inline constexpr int kState = 15;  ///< size of a frame's tangent

/// One frame set in the window. Its tangent is that of Preintegration: position (odom axes),
/// rotation (right perturbation), velocity, gyro bias, accelerometer bias.
struct WindowFrame {
  int id = 0;  ///< counts frame sets
  TimeNs t_ns = 0;
  bool keyframe = false;
  std::uint64_t cameras = 0;         ///< that saw something here, one bit each
  std::uint64_t steady_cameras = 0;  ///< of them, those that did in the frame set before, too

  NavState state;
  ImuBias bias;

  /// First-estimate Jacobians: once a prior refers to this frame, Jacobians are taken at the point
  /// where it was linearised, and the state is that point plus delta
  /// (docs/math/marginalisation.md).
  bool linearised = false;
  NavState lin_state;
  ImuBias lin_bias;
  Vector15d delta = Vector15d::Zero();

  /// Readings since the frame before it in the window; absent where the prior holds that link.
  std::optional<Preintegration> imu;
  Matrix15d imu_sqrt_information = Matrix15d::Zero();
  double imu_noise_factor = 1.0;  ///< that they were summed with (InertialNoise)
  bool imu_outdated = false;      ///< to be summed again: readings came, or were left out, since

  int still_since = -1;  ///< id of the frame where the car came to rest; -1 in motion

  /// Velocity of the vehicle's origin in the vehicle frame, and how well each axis is known; sigma
  /// 0 means nothing is known of that axis.
  Eigen::Vector3d body_velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d body_velocity_sigma = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();  ///< reading at the frame, rad/s

  /// The state used for Jacobians.
  [[nodiscard]] const NavState& jacobianState() const { return linearised ? lin_state : state; }
  [[nodiscard]] const ImuBias& jacobianBias() const { return linearised ? lin_bias : bias; }
  /// Adds a tangent step to the state.
  void apply(const Vector15d& step);
  /// Fixes the point of linearisation at the present state.
  void fixLinearisation();
};

/// Gravity in the odom frame. The odom frame is fixed to the first pose, not to the vertical: how
/// it is tilted stays uncertain long after (the accelerometer's bias looks the same on a straight),
/// so the direction of gravity is a state of two degrees of freedom. Poses then never have to move
/// when the vertical is found (docs/math/marginalisation.md).
struct WindowGravity {
  Eigen::Vector3d vector = Eigen::Vector3d(0.0, 0.0, -9.81);  ///< m/s^2
  bool linearised = false;
  Eigen::Vector3d lin_vector = Eigen::Vector3d(0.0, 0.0, -9.81);
  Eigen::Vector2d delta = Eigen::Vector2d::Zero();  ///< rad, from lin_vector

  /// The vector used for Jacobians.
  [[nodiscard]] const Eigen::Vector3d& jacobianVector() const {
    return linearised ? lin_vector : vector;
  }
  /// d vector / d step at jacobianVector().
  [[nodiscard]] Eigen::Matrix<double, 3, 2> basis() const;
  void apply(const Eigen::Vector2d& step);
  void fixLinearisation();
};

struct WindowObservation {
  int frame_id = 0;
  int camera = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector3d ray = Eigen::Vector3d::Zero();  ///< unit, camera frame
  /// How fast the landmark moves in the image, px/s, where the time offset is refined. From the
  /// frame's velocity, for differences of pixels would correlate with their noise.
  Eigen::Vector2d pixel_rate = Eigen::Vector2d::Zero();
  double sigma_px = 1.0;
  /// When its row is read, from -0.5 of the camera's readout time for the first row to 0.5; 0 of
  /// cameras that take all rows at once.
  double row_share = 0.0;
};

/// Features of one frame set and where they were seen.
using Observations = std::vector<std::pair<std::uint64_t, WindowObservation>>;

/// The cameras of one frame set that saw something, one bit each.
std::uint64_t camerasOf(const Observations& observations);

/// What is known of a landmark's inverse distance before any image: it keeps those without parallax
/// (a car at rest, pure turning) where landmarks are; a few millimetres of motion outweigh it. All
/// landmarks together would tell lengths with it, though (docs/math/residuals.md, eq. 4), so those
/// that leave the window, tens of thousands in a drive, leave less of it behind.
inline constexpr double kPriorInverseDistance = 0.15;               // 1/m
inline constexpr double kPriorInverseDistanceInformation = 1.0;     // m^2: 1 per metre, 1 sigma
inline constexpr double kLeavingInverseDistanceInformation = 0.04;  // m^2: 5 per metre, 1 sigma

/// A landmark: a direction and an inverse distance in the camera that saw it first. Three degrees
/// of freedom: two in the plane across the direction, then the inverse distance.
struct WindowFeature {
  std::uint64_t id = 0;
  std::vector<WindowObservation> observations;  ///< in the order of time
  bool has_point = false;
  bool selected = false;  ///< takes part in the solve
  int anchor_frame_id = 0;
  int anchor_camera = 0;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit, anchor camera frame
  double inverse_distance = 0.0;                         ///< 1/m; below zero: far, and noise
  int failures = 0;                                      ///< how often its point was thrown away
  int last_seen_id = 0;                                  ///< newest frame that saw it
  double noise_factor = 1.0;  ///< of its views' sigmas (docs/math/residuals.md, eq. 3b)
};

/// What is known of states of the window from all that left it: a quadratic in the deltas of the
/// frames and, last, of the globals, 0.5 d' H d + b' d.
struct WindowPrior {
  std::vector<int> frame_ids;
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
};

/// Where the first frame is: holds its pose, and what is known of velocity, biases and gravity.
struct StartPrior {
  int frame_id = -1;  ///< -1: absent
  NavState state;
  ImuBias bias;
  Vector15d sigma = Vector15d::Zero();  ///< rotation in odom axes; 0 means unknown
  Eigen::Vector3d gravity = Eigen::Vector3d(0.0, 0.0, -9.81);
  double gravity_sigma = 0.0;  ///< rad, of its direction; 0 means unknown
};

struct Window {
  std::vector<VioCamera> cameras;
  SE3 T_imu_vehicle;
  WindowGravity gravity;
  std::vector<CameraRefinement> refinements;  ///< one per camera, or none: calibration is believed
  std::vector<WindowFrame> frames;            ///< in the order of time
  std::map<std::uint64_t, WindowFeature> features;
  WindowPrior prior;
  StartPrior start;

  /// Position in frames of a frame id, or -1.
  [[nodiscard]] int indexOf(int frame_id) const;
  [[nodiscard]] WindowFrame* find(int frame_id);
  [[nodiscard]] const WindowFrame* find(int frame_id) const;
  /// The globals: gravity's two degrees of freedom, then those of every refined camera.
  [[nodiscard]] Eigen::Index globalSize() const;
  static constexpr Eigen::Index kGravitySize = 2;
  /// Where a refined camera's begin among the globals.
  [[nodiscard]] static constexpr Eigen::Index cameraGlobal(std::size_t camera) {
    return kGravitySize + kCalibration * static_cast<Eigen::Index>(camera);
  }
  [[nodiscard]] Eigen::VectorXd globalDelta() const;
  void applyGlobals(const Eigen::VectorXd& step);
  void fixGlobals();
  /// A feature's point in the odom frame.
  [[nodiscard]] Eigen::Vector3d pointOf(const WindowFeature& feature) const;
};

/// An observation's pixel at the frame's instant, given its camera's time offset.
Eigen::Vector2d observedPixel(const Window& window, const WindowObservation& observation);

/// Two unit vectors across a direction, as columns; a smooth function of it but near -z.
Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& direction);

/// Moves a feature's anchor to another of its observations; the point stays where it is. False
/// where it lies at the new camera's centre or at infinity behind it.
bool moveAnchor(const Window& window, WindowFeature& feature, const WindowObservation& to);

/// Inverse of the Cholesky factor of the readings' covariance, floored so that a single step (which
/// cannot tell position from velocity) is still invertible.
Matrix15d sqrtInformation(const Preintegration& imu);

}  // namespace parkade
