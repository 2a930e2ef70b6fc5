// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/camera/radtan.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace parkade {
namespace {

constexpr double kMaxAngle = 89.5 * std::numbers::pi / 180.0;

// Whether the map is locally one-to-one and keeps its orientation at radius r, in all directions.
bool growsAt(const RadtanDistortion& distortion, double radius) {
  constexpr int kDirections = 64;
  for (int i = 0; i < kDirections; ++i) {
    const double phi = 2.0 * std::numbers::pi * i / kDirections;
    Eigen::Matrix2d jacobian;
    const Eigen::Vector2d m(radius * std::cos(phi), radius * std::sin(phi));
    const double along = distortion.distort(m, &jacobian).dot(m);
    if (!(jacobian.determinant() > 0.0 && jacobian.trace() > 0.0 && along > 0.0)) return false;
  }
  return true;
}

}  // namespace

bool RadtanDistortion::undistort(const Eigen::Vector2d& distorted, double max_radius,
                                 Eigen::Vector2d& m) const {
  constexpr int kMaxIterations = 50;
  constexpr int kMaxHalvings = 30;
  const double scale = 1.0 + distorted.norm();
  m = distorted;
  if (m.norm() > max_radius) m *= max_radius / m.norm();
  Eigen::Matrix2d jacobian;
  Eigen::Vector2d residual = distort(m, &jacobian) - distorted;
  for (int i = 0; i < kMaxIterations && residual.norm() > 1e-15 * scale; ++i) {
    const Eigen::Vector2d step = jacobian.inverse() * residual;
    // Newton, halved until it helps: near the fold a whole step may jump over it.
    double ratio = 1.0;
    bool improved = false;
    for (int k = 0; k < kMaxHalvings && !improved; ++k, ratio *= 0.5) {
      Eigen::Vector2d next = m - ratio * step;
      if (next.norm() > max_radius) next *= max_radius / next.norm();
      Eigen::Matrix2d next_jacobian;
      const Eigen::Vector2d next_residual = distort(next, &next_jacobian) - distorted;
      improved = next_residual.squaredNorm() < residual.squaredNorm();
      if (improved) {
        m = next;
        residual = next_residual;
        jacobian = next_jacobian;
      }
    }
    if (!improved) break;
  }
  return residual.norm() < 1e-11 * scale;
}

double RadtanDistortion::oneToOneRadius() const {
  constexpr double kStep = 0.25 * std::numbers::pi / 180.0;
  // The directions are sampled: the margin covers a fold that lies between two of them.
  constexpr double kMargin = 0.999;
  double inside = 0.0;
  for (double angle = kStep; inside < kMaxAngle; angle += kStep) {
    double outside = std::min(angle, kMaxAngle);
    if (!growsAt(*this, std::tan(outside))) {
      while (outside - inside > 1e-9) {
        const double middle = 0.5 * (inside + outside);
        (growsAt(*this, std::tan(middle)) ? inside : outside) = middle;
      }
      return kMargin * std::tan(inside);
    }
    inside = outside;
  }
  return std::tan(kMaxAngle);
}

}  // namespace parkade
