// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/types/landmark.hpp"
#include "parkade/types/motion_prior.hpp"
#include "parkade/types/pose_estimate.hpp"
#include "parkade/types/samples.hpp"
#include "parkade/types/track.hpp"
#include "parkade/types/trajectory.hpp"
#include "parkade/vio/options.hpp"
#include "parkade/vio/predictor.hpp"
#include "parkade/vio/rig_error.hpp"

namespace parkade {

/// What the last addTracks() did, for time tables, plots and tests.
struct VioStatistics {
  int frames = 0;     ///< in the window
  int keyframes = 0;  ///< of them
  int landmarks = 0;  ///< in the solve
  int observations = 0;
  int iterations = 0;
  int rejected_observations = 0;
  std::vector<int> rejected_cameras;  ///< that contradict the prediction as a whole
  bool standstill = false;
  bool contradicted = false;      ///< by most cameras: the prediction
  double span_s = 0.0;            ///< from the window's oldest frame to its newest
  int imu_readings = 0;           ///< kept
  double imu_noise_factor = 1.0;  ///< how many times larger the unit's errors are than told
};

/// Where a camera sits on the car, how its clock is off and how long it reads, as refined online.
struct CameraCalibrationEstimate {
  SE3 T_vehicle_cam;
  double time_offset = 0.0;   ///< s; added to a stamp gives the time on the IMU's clock
  double readout_time = 0.0;  ///< s from the first row to the last (RigCamera)
  /// Standard deviations: position (m, imu axes), rotation (rad, camera axes), time offset (s),
  /// readout time (s); 0 of what is not refined.
  Eigen::Matrix<double, 8, 1> sigma = Eigen::Matrix<double, 8, 1>::Zero();
};

/// Visual-inertial odometry over any number of cameras: a sliding window of keyframes and recent
/// frames, optimised at every frame set; what leaves the window stays as a prior. Eats tracks,
/// never images. See docs/math/{preintegration,residuals,marginalisation,start_up}.md.
///
/// The same calls give the same bytes. Not thread-safe; predictor() copies what another thread
/// needs.
class VioEstimator {
 public:
  VioEstimator(const Rig& rig, const VioOptions& options);
  ~VioEstimator();
  VioEstimator(VioEstimator&&) noexcept;
  VioEstimator& operator=(VioEstimator&&) noexcept;

  /// Readings in the order of time; one that is not newer than the last, not finite, or beyond what
  /// a vehicle does is dropped with a warning.
  void addImu(const ImuSample& sample);
  void addWheel(const WheelSample& sample);

  /// Takes one frame set and gives the pose there. TrackSet::t_ns is on the IMU's clock. Call it
  /// when all IMU readings up to that instant were added, best also the first one after it: the
  /// reading there is interpolated, else the last one held. While the health is kInitialising there
  /// is no pose yet. A set that is not newer than the last is ignored: the last estimate comes
  /// back.
  PoseEstimate addTracks(const TrackSet& tracks);

  /// Where the car and the known features will be at t_ns, given the readings added so far;
  /// previous is the last frame set added.
  [[nodiscard]] MotionPrior predict(TimeNs t_ns) const;
  /// A copy of the newest state that predicts on its own, for a front end that runs ahead in
  /// another thread: give it the later IMU readings.
  [[nodiscard]] MotionPredictor predictor() const;

  /// Landmarks of the last solve.
  [[nodiscard]] std::vector<Landmark> landmarks() const;

  /// One per camera where vio.calibration refines them, else empty. Before the start: as given.
  [[nodiscard]] std::vector<CameraCalibrationEstimate> calibration() const;
  /// How uncertain the refined cameras are in what they share (vio/rig_error.hpp). 0 before the
  /// start and where they are not refined.
  [[nodiscard]] RigSigma rigSigma() const;

  /// Every frame set since the start, re-estimated with all that came after it: frames of the
  /// window as last solved, older ones corrected through the keyframes that left it; z points up
  /// as known at the end.
  [[nodiscard]] Trajectory finalTrajectory() const;

  [[nodiscard]] const VioStatistics& statistics() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace parkade
