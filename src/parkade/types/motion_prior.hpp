// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "parkade/core/time.hpp"
#include "parkade/geometry/se3.hpp"

namespace parkade {

/// What the front end may know before it looks at a frame set: how the car moved since the previous
/// one, and where known features are. From the estimator (imu propagation), or absent.
struct MotionPrior {
  bool valid = false;  ///< the rotation below can be trusted
  bool translation_valid = false;
  TimeNs previous_t_ns = 0;  ///< the frame set that "previous" means
  SE3 T_previous_current;    ///< vehicle frame now, seen from the vehicle frame then
  /// Points of features by track id, in the vehicle frame of the previous frame set, m.
  std::unordered_map<std::uint64_t, Eigen::Vector3d> p_previous;
  /// How long each camera's rolling shutter reads as far as known by now, s; empty: as told last,
  /// at first by the rig.
  std::vector<double> readout_times;
};

}  // namespace parkade
