// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

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
  double best_view = 0.0;  // share of its middle seen over its entrance, of the best picture so far
  TimeNs availability_ns = 0;
  double support = 0.0;  // sum of confidences, each for as much as the look was sharp
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

/// floor: m, a corner is not measured better than this.
Seen toWorld(const SlotObservation& o, const SE2& T, double floor);

/// What a look is worth by how well it tells the entrance's corners, where several readings of a
/// place contradict each other: 1 at 3 cm, 0.38 at 8 cm (the end of a worn line passes for a
/// corner).
double sharpness(const Matrix4& covariance);

/// The track that each observation is of, at most one of each, the likeliest pairs first; none
/// where it is of none. sigma: m, of corners beside their covariances. gate: of the squared
/// Mahalanobis distance.
std::vector<std::optional<std::size_t>> matchTracks(const std::vector<Track>& tracks,
                                                    const std::vector<Seen>& all, double sigma,
                                                    double gate);

/// Whether a picture shows the ground at the slot's entrance, at both corners and between them.
bool showsEntrance(const BevLabels& labels, const SE2& T_vehicle_world, const Track& track);

/// Whether two tracks have grown together: passes that were drawn apart saw one slot.
bool areOne(const Track& a, const Track& b, double duplicate_overlap);

/// What both have seen. The shape is that of the one seen more often, the id that of the first.
Track merged(Track first, Track second);

}  // namespace parkade::slot_registry
