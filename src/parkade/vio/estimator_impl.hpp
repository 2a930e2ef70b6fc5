// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "parkade/imu/reading_buffer.hpp"
#include "parkade/imu/standstill.hpp"
#include "parkade/vio/estimator.hpp"
#include "parkade/vio/feature_manager.hpp"
#include "parkade/vio/history.hpp"
#include "parkade/vio/image_rest.hpp"
#include "parkade/vio/inertial_noise.hpp"
#include "parkade/vio/start_up.hpp"
#include "parkade/vio/window.hpp"
#include "parkade/vio/window_solver.hpp"

namespace parkade {

/// Sigma of what is not refined of a camera: nothing outweighs it. m, rad, s.
inline constexpr double kHeldCalibration = 1e-6;

/// Velocity of the vehicle's origin, odom frame, m/s.
Eigen::Vector3d originVelocity(const WindowFrame& frame, const SE3& T_imu_vehicle);

class VioEstimator::Impl {
 public:
  Impl(const Rig& rig, const VioOptions& options);

  void addImu(const ImuSample& sample);
  void addWheel(const WheelSample& sample);
  PoseEstimate addTracks(const TrackSet& tracks);
  MotionPredictor predictor() const;
  std::vector<Landmark> landmarks() const;
  Trajectory finalTrajectory() const;
  std::vector<CameraCalibrationEstimate> calibration() const;
  RigSigma rigSigma() const;

  VioStatistics statistics;
  TimeNs last_t_ns = 0;
  bool has_frame = false;

 private:
  // Start-up (estimator_start.cpp).
  PoseEstimate startUp(const TrackSet& tracks);
  void trimStartFrames();
  bool startAtRest();
  bool startInMotion();
  struct StartTrial {
    Window window;
    SolveSummary summary;
    int landmarks = 0;
    double speed = 0.0;        ///< m/s
    double speed_sigma = 0.0;  ///< m/s
    double median_distance = 1.0;
    [[nodiscard]] double cost() const;  ///< per observation
    [[nodiscard]] bool fits() const;
    [[nodiscard]] bool sharp() const;
    [[nodiscard]] double penalty() const;
  };
  StartTrial tryStart(std::vector<NavState> states, const ImuBias& bias, StartPrior prior);
  /// The same motion with another velocity at the first frame.
  [[nodiscard]] std::vector<NavState> withVelocity(const std::vector<NavState>& states,
                                                   const Eigen::Vector3d& first) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> wheelVelocity(const NavState& first) const;
  void enterWindow(const std::vector<NavState>& states, std::size_t first, const ImuBias& bias,
                   const StartPrior& prior);
  /// The cameras stand as they were told, or as the run before a restart left them.
  void forgetCalibration();
  void restart(const std::string& reason);
  /// Moves states of a start about their own origin to where the last run of the window ended.
  void continueFromLast(std::vector<NavState>& states, StartPrior& prior) const;

  // Each frame set (estimator_frame.cpp, estimator.cpp).
  void addFrame(const TrackSet& tracks);
  void setImu(WindowFrame& frame, TimeNs begin_ns, const ImuBias& bias) const;
  void sumOutdatedAgain();
  /// From the last frame but one, whose motion is known from both sides.
  void learnInertialNoise();
  /// Where the readings since the frame before take a frame. Returns the covariance of its position
  /// (odom axes) and rotation relative to that frame.
  Eigen::Matrix<double, 6, 6> predictFrame(WindowFrame& frame, const WindowFrame& previous) const;
  GateResult gateNewest(const Eigen::Matrix<double, 6, 6>& spread);
  void dropOldReadings(TimeNs now_ns);
  void addBodyVelocity(WindowFrame& frame) const;
  void optimise(const SolveOptions& options);
  void updateHealth(const TrackSet& tracks, const GateResult& gate);

  // Rest (estimator_rest.cpp).
  void detectStandstill(WindowFrame& frame, const Observations& observations);
  /// Since the oldest of the recent tracks of a same camera; nothing where too few features are
  /// known from there.
  [[nodiscard]] std::optional<bool> imagesStill(const Observations& observations,
                                                TimeNs t_ns) const;
  [[nodiscard]] bool readingsAreOfRest(const WindowFrame& frame, const StillnessCheck& check,
                                       bool was_still) const;
  [[nodiscard]] bool wheelsTurn(const WindowFrame& frame, double sigmas) const;
  void rememberRest(const WindowFrame& frame, const StillnessCheck& check, bool seen);
  void rememberTracks(const Observations& observations, TimeNs t_ns);

  // The window's frames (estimator_window.cpp).
  void trimWindow();
  /// The last keyframe before a frame; null where there is none.
  [[nodiscard]] const WindowFrame* keyframeBefore(std::size_t index) const;
  /// The last one in which a camera saw something, for each camera of a frame; cameras may take
  /// turns.
  [[nodiscard]] std::vector<const WindowFrame*> keyframesBefore(std::size_t index) const;
  /// What a frame's features have in common with the frame after it and with keyframes.
  struct Overlap {
    int seen = 0;
    int expected = 0;   ///< of them, in the frame after: its cameras should be there, too
    int continued = 0;  ///< of these, found there
    int shared = 0;     ///< with their cameras' keyframes
    std::vector<double> parallax;  ///< rad, of those, without rotation
  };
  [[nodiscard]] Overlap overlapOf(std::size_t index,
                                  const std::vector<const WindowFrame*>& keyframes) const;
  [[nodiscard]] bool wantsKeyframe(std::size_t index) const;
  void removeFrame(std::size_t index);
  void marginaliseOldestKeyframe();

  [[nodiscard]] PoseEstimate estimate() const;
  [[nodiscard]] SolveOptions solveOptions(int max_iterations) const;
  [[nodiscard]] SolveOptions startOptions() const;

  VioOptions options_;
  bool learns_sigmas_ = true;  // of the calibration
  bool is_car_ = false;        // the vehicle frame's origin is below a rear axle
  double wheel_track_ = 0.0;
  ImuNoise noise_;  // as told, with vio.imu_noise_factor
  InertialNoise inertial_noise_;
  TimeNs gap_ns_ = 0;
  SE3 T_vehicle_imu_;
  Window window_;
  FeatureManager features_;
  VioHistory history_;
  ReadingBuffer readings_;
  bool told_of_isolated_ = false;
  std::deque<WheelSample> wheels_;

  bool initialised_ = false;
  std::vector<StartUpFrame> start_frames_;
  std::string start_reason_ = "waiting for images and IMU readings";
  int next_id_ = 0;

  bool still_ = false;
  int still_anchor_id_ = -1;
  struct RecentTracks {
    TimeNs t_ns = 0;
    Observations observations;
  };
  std::deque<RecentTracks> recent_tracks_;
  struct KnownRest {
    TimeNs t_ns = 0;
    bool seen = false;  ///< images vouched for it
    SO3 R_odom_imu;
    RestReadings readings;
  };
  std::optional<KnownRest> known_rest_;  ///< the last one, while the car can hardly have moved

  PoseEstimate last_;
  Matrix15d newest_covariance_ = Matrix15d::Zero();  ///< window's tangent
  Eigen::MatrixXd global_covariance_ = Eigen::MatrixXd::Zero(2, 2);
  int solved_landmarks_ = 0;
  TimeNs last_vision_ns_ = 0;
  Health health_ = Health::kInitialising;
  std::string reason_;
  // Where the last window ended, for a restart.
  bool has_last_run_ = false;
  NavState last_run_state_;
  TimeNs last_run_t_ns_ = 0;
  Matrix15d last_run_covariance_ = Matrix15d::Zero();
  Eigen::Vector3d last_run_gravity_ = Eigen::Vector3d(0.0, 0.0, -9.81);
  double last_run_gravity_sigma_ = 0.0;  ///< rad
  std::vector<Landmark> last_landmarks_;
};

}  // namespace parkade
