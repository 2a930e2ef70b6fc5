// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>

#include "parkade/geometry/se3.hpp"
#include "parkade/sim/drive/path.hpp"
#include "parkade/sim/drive/speed_profile.hpp"
#include "parkade/sim/drive/uniform_spline.hpp"

namespace parkade::sim {

inline constexpr double kGravity = 9.81;  ///< m/s2

/// Height of the ground that wheels roll on, with speed bumps, at a place of the garage frame, m.
using SurfaceHeight = std::function<double(const Eigen::Vector2d&)>;

/// How the sprung body sits and moves on its wheels. Gradients of a sedan.
struct SuspensionOptions {
  double wheelbase = 2.85;                ///< m
  double track = 1.6;                     ///< m
  double wheel_radius = 0.33;             ///< m
  double center_height = 0.3;             ///< m; the body pitches and rolls about a point this high
  double roll_gradient_deg_per_g = 5.0;   ///< in corners, outwards
  double pitch_gradient_deg_per_g = 2.0;  ///< nose down while braking
  double heave_hz = 1.4;
  double pitch_hz = 1.6;
  double roll_hz = 1.8;
  double damping = 0.35;             ///< share of the critical
  double wheel_hz = 10.0;            ///< of the wheel on its tyre
  double static_pitch_deg = 0.0;     ///< of the load, nose down > 0
  double static_roll_deg = 0.0;      ///< of the load, right side down > 0
  double static_heave = 0.0;         ///< m, of the load, up > 0
  double road_roughness = 0.0008;    ///< m, standard deviation of the ground's unevenness
  std::uint64_t roughness_seed = 1;  ///< the same unevenness for the same seed, place by place
};

/// What the car does at one moment.
struct MotionState {
  SE3 T_world_vehicle;
  Eigen::Vector3d velocity_world;             ///< m/s, of the vehicle frame's origin
  Eigen::Vector3d acceleration_world;         ///< m/s^2
  Eigen::Vector3d angular_velocity_body;      ///< rad/s, vehicle frame
  Eigen::Vector3d angular_acceleration_body;  ///< rad/s^2, vehicle frame
};

/// The motion of the car's body with six degrees of freedom, C4 in position and attitude, with
/// exact derivatives. The vehicle frame is fixed to the sprung body (and so to the cameras):
/// unloaded and at rest on level ground its origin lies on the ground below the rear axle's centre;
/// it then moves with pitch, roll and heave. The rear axle's centre follows the path, the wheels
/// follow the ground through tyre and suspension, and accelerations tilt the body.
class VehicleMotion {
 public:
  VehicleMotion(const Path& path, const SpeedProfile& profile, const SurfaceHeight& surface,
                const SuspensionOptions& options);

  [[nodiscard]] double duration() const { return duration_; }  ///< s
  /// t in seconds, clamped into [0, duration()].
  [[nodiscard]] MotionState at(double t) const;
  [[nodiscard]] SE3 pose(double t) const;

 private:
  UniformSpline<6> spline_;  // x, y, z of the body's centre of rotation; yaw, pitch, roll
  Eigen::Vector3d center_body_ = Eigen::Vector3d::Zero();
  double duration_ = 0.0;
};

/// What the wheels and the steering do, exactly.
struct WheelState {
  double rear_left = 0.0;   ///< m/s along the ground, < 0 in reverse
  double rear_right = 0.0;  ///< m/s
  double steering = 0.0;    ///< rad, road wheel angle of a one-track model, left > 0
};
WheelState wheelState(const Path& path, const SpeedProfile& profile, const SurfaceHeight& surface,
                      const SuspensionOptions& options, double t);

}  // namespace parkade::sim
