// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests that label images agree with the garage: what its own vector objects say of a place.
#include <Eigen/Dense>
#include <algorithm>
#include <utility>
#include <vector>

#include "parkade/geometry/planar.hpp"
#include "parkade/sim/garage.hpp"
#include "parkade/sim/world/polygon.hpp"

namespace parkade::sim::test {

/// The distance from a point to a polygon's border.
inline double borderDistance(const Polygon& polygon, const Eigen::Vector2d& p) {
  double nearest = 1e9;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    nearest =
        std::min(nearest, distanceToSegment(p, polygon[i], polygon[(i + 1) % polygon.size()]));
  }
  return nearest;
}

/// The paint of a garage, by place.
class PaintTruth {
 public:
  explicit PaintTruth(const Garage& garage) {
    for (const Marking& marking : garage.markings) {
      for (const Polygon& polygon : marking.polygons) {
        Piece piece{marking.semantic_class, polygon, polygon.front(), polygon.front()};
        for (const Eigen::Vector2d& q : polygon) {
          piece.min = piece.min.cwiseMin(q);
          piece.max = piece.max.cwiseMax(q);
        }
        pieces_.push_back(std::move(piece));
      }
    }
  }

  /// The class that the markings give a place on the floor; unknown near any border.
  [[nodiscard]] SemanticClass at(const Eigen::Vector2d& p) const {
    constexpr double kMargin = 0.02;  // m
    SemanticClass found = SemanticClass::kFloor;
    for (const Piece& piece : pieces_) {
      if ((piece.min - p).maxCoeff() > kMargin || (p - piece.max).maxCoeff() > kMargin) continue;
      if (borderDistance(piece.polygon, p) < kMargin) return SemanticClass::kUnknown;
      if (!contains(piece.polygon, p)) continue;
      if (found != SemanticClass::kFloor && found != piece.semantic_class) {
        return SemanticClass::kUnknown;  // two kinds of paint, one over the other
      }
      found = piece.semantic_class;
    }
    return found;
  }

 private:
  struct Piece {
    SemanticClass semantic_class;
    Polygon polygon;
    Eigen::Vector2d min, max;
  };
  std::vector<Piece> pieces_;
};

/// Whether a place lies in a pillar, or within a margin of one.
inline bool inPillar(const Garage& garage, const Eigen::Vector2d& p, double margin = 0.03) {
  return std::any_of(garage.pillars.begin(), garage.pillars.end(), [&](const Pillar& pillar) {
    const Eigen::Vector2d d = (p - pillar.center).cwiseAbs();
    return d.x() < 0.5 * pillar.size.x() + margin && d.y() < 0.5 * pillar.size.y() + margin;
  });
}

}  // namespace parkade::sim::test
