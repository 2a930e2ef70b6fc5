// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/geometry/spline.hpp"
#include "parkade/types/pose_estimate.hpp"
#include "parkade/types/samples.hpp"
#include "parkade/types/track.hpp"
#include "parkade/vio/estimator.hpp"

// For tests and benchmarks only: a car in a garage-like corridor, seen as tracks and IMU readings
// without any image.

namespace parkade::testing {

struct TrackSimulatorOptions {
  std::uint64_t seed = 1;
  double length = 200.0;                   ///< m
  double initial_rest = 1.0;               ///< s
  std::vector<double> stops{70.0, 140.0};  ///< m along the way
  double stop_duration = 3.0;              ///< s
  double final_rest = 0.5;                 ///< s
  double start_speed = 0.0;                ///< m/s at the first frame, with initial_rest 0
  double max_speed = 4.17;                 ///< m/s
  double max_jerk = 8.0;                   ///< m/s^3
  double frame_rate = 10.0;                ///< Hz
  double imu_rate = 200.0;
  double pixel_sigma = 0.5;        ///< 0: exact pixels
  bool imu_noise = true;           ///< and biases
  double bias_gyro_sigma = 0.005;  ///< rad/s, turn-on
  double bias_accel_sigma = 0.1;   ///< m/s^2, turn-on
  int tracks_per_camera = 120;
  double mean_lifetime = 25.0;  ///< frames
  double match_rate = 0.3;    ///< of a neighbour camera's features that are found again, per frame
  double max_range = 14.0;    ///< m
  double camera_delay = 0.0;  ///< s, that stamps of tracks lag behind the instant of the picture
};

/// Six cameras of 640x400 pixels and 100 deg around a car, neighbours overlap; the IMU is a BMI088.
Rig surroundRig();
/// The two forward cameras of a stereo head, 752x480.
Rig stereoRig();

struct SimulatedDrive {
  Rig rig;
  SplineSE3 truth;
  std::vector<ImuSample> imu;
  std::vector<TrackSet> frames;
  double distance = 0.0;  ///< m

  /// The vehicle in the odom frame of the first frame: origin and heading there.
  [[nodiscard]] SE3 truthAt(TimeNs t_ns) const;
};

SimulatedDrive simulateDrive(const Rig& rig, const TrackSimulatorOptions& options);

/// Feeds a drive to an estimator, each frame after the readings up to its stamp and one beyond.
std::vector<PoseEstimate> runDrive(const SimulatedDrive& drive, VioEstimator& estimator);

struct DriveScore {
  int poses = 0;                    ///< delivered
  double first_pose = -1.0;         ///< s after the first frame
  double rmse = 0.0;                ///< m
  double max_error = 0.0;           ///< m
  double end_error = 0.0;           ///< m
  double max_yaw_error = 0.0;       ///< rad
  double end_yaw_error = 0.0;       ///< rad
  double end_tilt_error = 0.0;      ///< rad, of the vertical
  double mean_nees_position = 0.0;  ///< 3 expected
  double mean_nees_yaw = 0.0;       ///< 1 expected
  double end_nees_position = 0.0;
  double end_nees_yaw = 0.0;
};

/// Trajectories are joined at the first pose delivered.
DriveScore score(const SimulatedDrive& drive, const std::vector<PoseEstimate>& estimates);

}  // namespace parkade::testing
