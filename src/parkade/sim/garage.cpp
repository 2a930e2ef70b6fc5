// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/garage.hpp"

#include <algorithm>
#include <cmath>

namespace parkade::sim {
namespace {

double rampHeight(const Garage::Ramp& ramp, const Eigen::Vector2d& p) {
  const double u = std::clamp((p - ramp.start).dot(ramp.direction) / ramp.length, 0.0, 1.0);
  return ramp.rise * (u - std::sin(2.0 * M_PI * u) / (2.0 * M_PI));
}

double bumpHeight(const Garage::Bump& bump, const Eigen::Vector2d& p) {
  const Eigen::Vector2d d = p - bump.center;
  const double along = d.x() * std::cos(bump.heading) + d.y() * std::sin(bump.heading);
  const double across = -d.x() * std::sin(bump.heading) + d.y() * std::cos(bump.heading);
  const double s = along / (0.5 * bump.length);
  const double margin = 0.5 * bump.width - std::abs(across);
  if (std::abs(s) >= 1.0 || margin <= 0.0) return 0.0;
  constexpr double kEdge = 0.05;
  const double e = std::min(margin / kEdge, 1.0);
  const double taper = e * e * e * (e * (6.0 * e - 15.0) + 10.0);
  return bump.height * std::pow(1.0 - s * s, 3) * taper;
}

}  // namespace

double Garage::area() const {
  double twice = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

double Garage::floorHeight(const Eigen::Vector2d& p) const {
  double height = 0.0;
  for (const Ramp& ramp : ramps) height += rampHeight(ramp, p);
  return height;
}

double Garage::surfaceHeight(const Eigen::Vector2d& p) const {
  double height = floorHeight(p);
  for (const Bump& bump : bumps) height += bumpHeight(bump, p);
  return height;
}

std::vector<std::pair<double, double>> Garage::openings(const Eigen::Vector2d& a,
                                                        const Eigen::Vector2d& b) const {
  constexpr double kOnWall = 0.01;  // m
  const double length = (b - a).norm();
  const Eigen::Vector2d along = (b - a) / length;
  const Eigen::Vector2d across(-along.y(), along.x());
  std::vector<std::pair<double, double>> openings;
  for (const Entrance& entrance : entrances) {
    const double s = (entrance.center - a).dot(along);
    const double off = std::abs((entrance.center - a).dot(across));
    if (off > kOnWall || s < 0.0 || s > length) continue;
    openings.emplace_back(s - 0.5 * entrance.width, s + 0.5 * entrance.width);
  }
  std::sort(openings.begin(), openings.end());
  return openings;
}

}  // namespace parkade::sim
