// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "parkade/core/random.hpp"
#include "parkade/types/trajectory.hpp"

// For tests only: trajectories whose errors are known.

namespace parkade::testing {

inline Eigen::Vector3d noise(Random& random, double sigma) {
  return {random.normal(0.0, sigma), random.normal(0.0, sigma), random.normal(0.0, sigma)};
}

/// Straight along x at 1 m per step, level, one pose every step_s.
inline Trajectory straight(int count, double step_s = 0.1, TimeNs start_ns = 1'000'000'000) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    trajectory.push_back(
        {start_ns + i * fromSeconds(step_s), SE3(SO3(), {static_cast<double>(i), 0.0, 0.0})});
  }
  return trajectory;
}

/// At one place.
inline Trajectory standing(int count) {
  Trajectory trajectory = straight(count);
  for (auto& pose : trajectory) pose.T_world_body = SE3();
  return trajectory;
}

/// A winding drive through three dimensions, 0.5 m per pose, heading along the way.
inline Trajectory winding(int count, double step_s = 0.1, TimeNs start_ns = 1'000'000'000) {
  Trajectory trajectory;
  SE3 T;
  for (int i = 0; i < count; ++i) {
    trajectory.push_back({start_ns + i * fromSeconds(step_s), T});
    const double yaw_step = 0.06 * std::sin(0.05 * i);
    const double pitch_step = 0.01 * std::cos(0.03 * i);
    T = T * SE3(SO3::fromYawPitchRoll(yaw_step, pitch_step, 0.0), {0.5, 0.0, 0.0});
  }
  return trajectory;
}

/// The trajectory in another frame: T_other_world * (scale * pose).
inline Trajectory moved(const Trajectory& trajectory, const SE3& T_other_world,
                        double scale = 1.0) {
  Trajectory result = trajectory;
  for (auto& pose : result) {
    pose.T_world_body =
        T_other_world * SE3(pose.T_world_body.rotation(), scale * pose.T_world_body.translation());
  }
  return result;
}

}  // namespace parkade::testing
