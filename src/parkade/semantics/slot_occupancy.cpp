// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slot_occupancy.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/semantics/marking_pieces.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

// Where the thing that is labelled at p touches the floor: the last vehicle label on the way to
// the camera.
Vector2d footOf(const LabelProbe& probe, const BevViews& views, const Vector2d& p) {
  const BevGeometry& g = probe.labels().geometry;
  const Vector2d camera = views.viewAt(g, p).foot;
  const Vector2d way = camera - p;
  const double length = way.norm();
  const double step = 2.0 * g.metres_per_px;
  Vector2d foot = p;
  constexpr double kGap = 0.2;  // m that labels may miss
  for (double s = step; s < length && (p + s / length * way - foot).norm() < kGap + step;
       s += step) {
    const Vector2d at = p + s / length * way;
    if (probe.at(at) == SemanticClass::kVehicle) foot = at;
  }
  return foot;
}

}  // namespace

double probabilityFree(const LabelProbe& probe, const BevViews& views,
                       const std::array<Vector2d, 4>& corners) {
  // Bilinear coordinates: a across from left to right, b from the entrance to the rear.
  const auto at = [&](double a, double b) -> Vector2d {
    return (1.0 - b) * ((1.0 - a) * corners[0] + a * corners[1]) +
           b * ((1.0 - a) * corners[3] + a * corners[2]);
  };
  const Vector2d front = corners[1] - corners[0];
  const Vector2d side = corners[3] - corners[0];
  const double area = std::abs(front.x() * side.y() - front.y() * side.x());
  const auto inside = [&](const Vector2d& p) {
    const Vector2d d = p - corners[0];
    const double a =
        (d.x() * side.y() - d.y() * side.x()) / (front.x() * side.y() - front.y() * side.x());
    const double b =
        (front.x() * d.y() - front.y() * d.x()) / (front.x() * side.y() - front.y() * side.x());
    // Wheels may stand on the line; the next slot's car does not.
    return a > -0.02 && a < 1.02 && b > -0.1 && b < 1.0;
  };
  if (area < 1e-3) return 0.5;
  // Any car covers this middle part: it is narrower and shorter than cars, wherever they stand.
  constexpr int kAcross = 9;
  constexpr int kDeep = 15;
  double floor = 0.0;
  double car = 0.0;
  for (int j = 0; j < kDeep; ++j) {
    const double b = 0.25 + 0.5 * j / (kDeep - 1);
    for (int i = 0; i < kAcross; ++i) {
      const Vector2d p = at(0.3 + 0.4 * i / (kAcross - 1), b);
      const SemanticClass c = probe.at(p);
      if (!hidesGround(c)) {
        floor += 1.0;
      } else if (c == SemanticClass::kVehicle && inside(footOf(probe, views, p))) {
        car += 1.0;
      }
    }
  }
  constexpr double kAll = kAcross * kDeep;
  // A sixth of the middle is enough to tell; labels that disagree cancel each other. A car leaves
  // no floor to see, while one beside the slot reaches into it: floor counts twice.
  constexpr double kEnough = 18.0;
  constexpr double kStrongest = 4.0;
  const double log_odds = kStrongest * std::clamp(kEnough * (2.0 * floor - car) / kAll, -1.0, 1.0);
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace parkade
