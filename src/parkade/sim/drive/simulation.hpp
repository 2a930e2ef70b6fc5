// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/result.hpp"
#include "parkade/core/time.hpp"
#include "parkade/sim/drive/routes.hpp"
#include "parkade/sim/drive/spec.hpp"
#include "parkade/sim/drive/vehicle_motion.hpp"
#include "parkade/sim/garage.hpp"
#include "parkade/types/samples.hpp"

namespace parkade::sim {

/// The stamp of the drive's beginning.
inline constexpr TimeNs kSimStartNs = 1000 * kNsPerSecond;

/// The car at the moment of an inertial sample, and what the sample contains.
struct TruthState {
  TimeNs t_ns = 0;
  SE3 T_world_vehicle;
  Eigen::Vector3d velocity_world = Eigen::Vector3d::Zero();  ///< of the vehicle's origin, m/s
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();       ///< imu frame, rad/s
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();      ///< imu frame, m/s^2
};

/// A drive with everything but the pictures: made at once, then read only. World is the garage's
/// frame; times in seconds count from kSimStartNs.
class Simulation {
 public:
  /// Fails where the garage, the route or the rig cannot be made.
  static Result<std::shared_ptr<const Simulation>> make(const SimSpec& spec);

  [[nodiscard]] const SimSpec& spec() const { return spec_; }
  [[nodiscard]] const Garage& garage() const { return garage_; }
  [[nodiscard]] const Route& route() const { return route_; }
  [[nodiscard]] const Rig& trueRig() const { return true_rig_; }
  /// What the reader of the recording is told (calib_error_*).
  [[nodiscard]] const Rig& toldRig() const { return told_rig_; }

  [[nodiscard]] double duration() const { return duration_; }  ///< s
  /// s: to the end of the drive, where the recording may be cut short (SimSpec::duration).
  [[nodiscard]] double wholeDuration() const { return profile_.duration() - offset_; }
  [[nodiscard]] double drivenDistance() const;  ///< m
  [[nodiscard]] MotionState motionAt(double t) const { return motion_->at(t + offset_); }
  [[nodiscard]] SE3 T_world_vehicle(double t) const { return motion_->pose(t + offset_); }

  [[nodiscard]] const std::vector<ImuSample>& imu() const { return imu_; }
  [[nodiscard]] const std::vector<WheelSample>& wheel() const { return wheel_; }
  /// One per inertial sample.
  [[nodiscard]] const std::vector<TruthState>& truth() const { return truth_; }
  /// Middle of the exposure of every frame set; the cameras trigger together.
  [[nodiscard]] const std::vector<TimeNs>& frameTimes() const { return frame_times_; }

 private:
  Simulation() = default;
  void drive(const SuspensionOptions& suspension);
  void sense(const SuspensionOptions& suspension);

  SimSpec spec_;
  Garage garage_;
  Route route_;
  Rig true_rig_;
  Rig told_rig_;
  SpeedProfile profile_;
  std::unique_ptr<const VehicleMotion> motion_;
  double offset_ = 0.0;  // s of the drive before the recording begins
  double duration_ = 0.0;
  std::vector<ImuSample> imu_;
  std::vector<WheelSample> wheel_;
  std::vector<TruthState> truth_;
  std::vector<TimeNs> frame_times_;
};

}  // namespace parkade::sim
