// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/geometry/se2.hpp"

namespace parkade {

/// visit(place) for the places that a car's way was seen from: at every metre 1 m behind the rear
/// axle, 1 and 3 m ahead of it, for cameras are all around a car.
template <class Visit>
void forEachEye(const std::vector<SE2>& way, const Visit& visit) {
  constexpr double kSpacing = 1.0;
  const SE2* last = nullptr;
  for (const SE2& pose : way) {
    if (last != nullptr && (pose.translation() - last->translation()).norm() < kSpacing) continue;
    last = &pose;
    for (const double ahead : {-1.0, 1.0, 3.0}) visit(pose * Eigen::Vector2d(ahead, 0.0));
  }
}

}  // namespace parkade
