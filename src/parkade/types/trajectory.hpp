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

}  // namespace parkade
