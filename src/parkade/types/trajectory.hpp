// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/core/time.hpp"
#include "parkade/geometry/se3.hpp"

namespace parkade {

struct StampedPose {
  TimeNs t_ns = 0;
  SE3 T_world_body;  ///< body: the vehicle, or the imu of a recording without a car
};

/// Poses in the order of time.
using Trajectory = std::vector<StampedPose>;

/// Length of the polyline through the positions, metres.
inline double pathLength(const Trajectory& trajectory) {
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length +=
        (trajectory[i].T_world_body.translation() - trajectory[i - 1].T_world_body.translation())
            .norm();
  }
  return length;
}

}  // namespace parkade
