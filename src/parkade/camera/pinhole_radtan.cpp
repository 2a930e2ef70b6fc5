// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/camera/pinhole_radtan.hpp"

#include <fmt/core.h>

#include "parkade/core/check.hpp"

namespace parkade {

std::string PinholeRadtan::Parameters::problem() const {
  if (!(fx > 0.0 && fy > 0.0)) return fmt::format("focal lengths {} and {} must be > 0", fx, fy);
  return {};
}

PinholeRadtan::PinholeRadtan(const Parameters& parameters) : p_(parameters) {
  PARKADE_CHECK(p_.problem().empty(), "{}", p_.problem());
  const double radius = p_.distortion.oneToOneRadius();
  max_radius_squared_ = radius * radius;
}

bool PinholeRadtan::unproject(const Eigen::Vector2d& pixel, Eigen::Vector3d& ray_cam) const {
  const Eigen::Vector2d distorted((pixel.x() - p_.cx) / p_.fx, (pixel.y() - p_.cy) / p_.fy);
  Eigen::Vector2d m;
  if (!p_.distortion.undistort(distorted, std::sqrt(max_radius_squared_), m)) return false;
  ray_cam = Eigen::Vector3d(m.x(), m.y(), 1.0).normalized();
  return true;
}

PinholeRadtan PinholeRadtan::scaled(double factor_x, double factor_y) const {
  PinholeRadtan camera = *this;
  camera.p_.fx *= factor_x;
  camera.p_.fy *= factor_y;
  camera.p_.cx = (p_.cx + 0.5) * factor_x - 0.5;
  camera.p_.cy = (p_.cy + 0.5) * factor_y - 0.5;
  return camera;
}

}  // namespace parkade
