// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/camera/mei.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

// The sphere's point that the plane's point m stands for, as a unit ray; false where there is none.
bool lift(double xi, const Eigen::Vector2d& m, Eigen::Vector3d& ray) {
  const double r2 = m.squaredNorm();
  const double discriminant = 1.0 + (1.0 - xi * xi) * r2;
  if (!(discriminant >= 0.0)) return false;
  const double scale = (xi + std::sqrt(discriminant)) / (1.0 + r2);
  ray = {scale * m.x(), scale * m.y(), scale - xi};
  return true;
}

}  // namespace

std::string Mei::Parameters::problem() const {
  if (!(xi >= 0.0)) return fmt::format("xi = {} must be >= 0", xi);
  if (!(gamma1 > 0.0 && gamma2 > 0.0)) {
    return fmt::format("focal lengths {} and {} must be > 0", gamma1, gamma2);
  }
  return {};
}

Mei::Mei(const Parameters& parameters) : p_(parameters) {
  PARKADE_CHECK(p_.problem().empty(), "{}", p_.problem());
  double radius = p_.distortion.oneToOneRadius();
  // Beyond xi = 1 the plane's picture of the sphere is a disc.
  if (p_.xi > 1.0) radius = std::min(radius, 1.0 / std::sqrt(p_.xi * p_.xi - 1.0));
  max_radius_squared_ = radius * radius;
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();
  if (!lift(p_.xi, {radius, 0.0}, ray)) ray.z() = -1.0 / p_.xi;  // rounding at the disc's rim
  min_cosine_ = ray.z();
}

bool Mei::unproject(const Eigen::Vector2d& pixel, Eigen::Vector3d& ray_cam) const {
  const Eigen::Vector2d distorted((pixel.x() - p_.u0) / p_.gamma1, (pixel.y() - p_.v0) / p_.gamma2);
  Eigen::Vector2d m;
  if (!p_.distortion.undistort(distorted, std::sqrt(max_radius_squared_), m)) return false;
  if (!lift(p_.xi, m, ray_cam)) return false;
  ray_cam.normalize();
  return true;
}

Mei Mei::scaled(double factor_x, double factor_y) const {
  Mei camera = *this;
  camera.p_.gamma1 *= factor_x;
  camera.p_.gamma2 *= factor_y;
  camera.p_.u0 = (p_.u0 + 0.5) * factor_x - 0.5;
  camera.p_.v0 = (p_.v0 + 0.5) * factor_y - 0.5;
  return camera;
}

}  // namespace parkade
