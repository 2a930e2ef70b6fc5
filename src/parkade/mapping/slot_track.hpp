// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "parkade/core/time.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/types/semantic_features.hpp"

// Inside of the slot registry: what it holds of a slot, and an observation put into the world.

namespace parkade::slot_registry {

using Vector4 = Eigen::Vector4d;
using Matrix4 = Eigen::Matrix4d;
using Corners = std::array<Eigen::Vector2d, 4>;

struct Track {
  std::int64_t id = 0;
  std::int64_t anchor = 0;
  Vector4 entrance = Vector4::Zero();  // left x y, right x y
  Matrix4 covariance = Matrix4::Zero();
  Eigen::Vector2d rear_left = Eigen::Vector2d::Zero();   // from the entrance's left corner
  Eigen::Vector2d rear_right = Eigen::Vector2d::Zero();  // from its right corner
  double rear_weight = 0.0;
  double log_odds_free = 0.0;
  TimeNs availability_ns = 0;
  double confidence = 0.0;  // sum
  std::int64_t observations = 0;
  std::int64_t misses = 0;
  TimeNs last_seen_ns = 0;
  std::array<double, 3> shapes{};

  [[nodiscard]] Corners corners() const {
    const Eigen::Vector2d left = entrance.head<2>();
    const Eigen::Vector2d right = entrance.tail<2>();
    return {left, right, right + rear_right, left + rear_left};
  }
  [[nodiscard]] Eigen::Vector2d middle() const {
    return 0.5 * (entrance.head<2>() + entrance.tail<2>());
  }
  [[nodiscard]] Eigen::Vector2d centre() const {
    return middle() + 0.25 * (rear_left + rear_right);
  }
  [[nodiscard]] double width() const { return (entrance.tail<2>() - entrance.head<2>()).norm(); }
};

// An observation in the world.
struct Seen {
  Vector4 entrance = Vector4::Zero();
  Matrix4 covariance = Matrix4::Zero();
  Eigen::Vector2d rear_left = Eigen::Vector2d::Zero();
  Eigen::Vector2d rear_right = Eigen::Vector2d::Zero();
  const SlotObservation* source = nullptr;
};

inline double logOdds(double p) {
  const double inside = std::clamp(p, 0.02, 0.98);
  return std::log(inside / (1.0 - inside));
}

inline Seen toWorld(const SlotObservation& o, const SE2& T, double floor) {
  Seen seen;
  seen.source = &o;
  const Eigen::Vector2d left = T * o.corners[0];
  const Eigen::Vector2d right = T * o.corners[1];
  seen.entrance << left, right;
  seen.rear_right = T * o.corners[2] - right;
  seen.rear_left = T * o.corners[3] - left;
  Matrix4 R = Matrix4::Zero();
  R.topLeftCorner<2, 2>() = T.rotationMatrix();
  R.bottomRightCorner<2, 2>() = T.rotationMatrix();
  seen.covariance = R * o.entrance_covariance * R.transpose() + floor * floor * Matrix4::Identity();
  return seen;
}

// Same direction to within 25 degrees and middles nearer than half a width: no neighbour does that.
inline bool mayBeSame(const Track& track, const Seen& seen) {
  const Eigen::Vector2d a = track.entrance.tail<2>() - track.entrance.head<2>();
  const Eigen::Vector2d b = seen.entrance.tail<2>() - seen.entrance.head<2>();
  constexpr double kCosine = 0.906;
  if (a.dot(b) < kCosine * a.norm() * b.norm()) return false;
  const Eigen::Vector2d middle = 0.5 * (seen.entrance.head<2>() + seen.entrance.tail<2>());
  return (middle - track.middle()).norm() < 0.45 * std::min(a.norm(), b.norm());
}

}  // namespace parkade::slot_registry
