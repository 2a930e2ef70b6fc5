// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "parkade/sim/world/paint.hpp"

namespace parkade::sim {
namespace {

// Shares of an arrow's length.
constexpr double kShaft = 0.065;
constexpr double kHeadLength = 0.36;
constexpr double kHeadHalf = 0.115;
constexpr double kArm = 0.13;

Polygon rectangleOf(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// An arm that leaves the shaft at x to one side (1: left), with its head.
void addArm(double x, double side, double length, std::vector<Polygon>& out) {
  const double half = 0.5 * kShaft * length;
  const double reach = kArm * length;
  const double tip = reach + 0.8 * kHeadLength * length;
  Polygon arm = rectangleOf(x - half, 0.0, x + half, reach);
  Polygon head = {{x - kHeadHalf * length, reach}, {x + kHeadHalf * length, reach}, {x, tip}};
  for (Polygon* polygon : {&arm, &head}) {
    for (Eigen::Vector2d& p : *polygon) p.y() *= side;
    if (signedArea(*polygon) < 0.0) std::reverse(polygon->begin(), polygon->end());
    out.push_back(*polygon);
  }
}

}  // namespace

std::vector<Polygon> arrowPolygons(const std::string& meaning, double length) {
  const bool straight = meaning.find("straight") != std::string::npos;
  const bool left = meaning.find("left") != std::string::npos;
  const bool right = meaning.find("right") != std::string::npos;
  const double half = 0.5 * kShaft * length;
  const double tail = -0.5 * length;
  const double bend = straight ? -0.02 * length : 0.30 * length;
  std::vector<Polygon> out;
  if (straight) {
    const double neck = 0.5 * length - kHeadLength * length;
    out.push_back(rectangleOf(tail, -half, neck, half));
    out.push_back({{neck, -kHeadHalf * length}, {0.5 * length, 0.0}, {neck, kHeadHalf * length}});
  } else {
    out.push_back(rectangleOf(tail, -half, bend + half, half));
  }
  if (left) addArm(bend, 1.0, length, out);
  if (right) addArm(straight && left ? bend - 0.12 * length : bend, -1.0, length, out);
  return out;
}

}  // namespace parkade::sim
