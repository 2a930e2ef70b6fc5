// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/camera/pinhole_equidistant.hpp"

#include <fmt/core.h>

#include "parkade/camera/solve_monotonic.hpp"
#include "parkade/core/check.hpp"

namespace parkade {

std::string PinholeEquidistant::Parameters::problem() const {
  if (!(fx > 0.0 && fy > 0.0)) return fmt::format("focal lengths {} and {} must be > 0", fx, fy);
  return {};
}

PinholeEquidistant::PinholeEquidistant(const Parameters& parameters) : p_(parameters) {
  PARKADE_CHECK(p_.problem().empty(), "{}", p_.problem());
  max_angle_ = growingRange(
      [this](double theta) {
        double slope = 0.0;
        distortedAngle(theta, slope);
        return slope > 0.0;
      },
      kMaxFisheyeAngle);
  double slope = 0.0;
  max_distorted_angle_ = distortedAngle(max_angle_, slope);
}

bool PinholeEquidistant::unproject(const Eigen::Vector2d& pixel, Eigen::Vector3d& ray_cam) const {
  const double x = (pixel.x() - p_.cx) / p_.fx;
  const double y = (pixel.y() - p_.cy) / p_.fy;
  const double d = std::sqrt(x * x + y * y);
  if (!(d <= max_distorted_angle_)) return false;
  if (d < 1e-9) {
    ray_cam = Eigen::Vector3d(x, y, 1.0).normalized();
    return true;
  }
  const double theta = solveMonotonic(
      [this](double t, double& slope) { return distortedAngle(t, slope); }, d, 0.0, max_angle_, d);
  const double sine = std::sin(theta);
  ray_cam = {sine * x / d, sine * y / d, std::cos(theta)};
  return true;
}

PinholeEquidistant PinholeEquidistant::scaled(double factor_x, double factor_y) const {
  PinholeEquidistant camera = *this;
  camera.p_.fx *= factor_x;
  camera.p_.fy *= factor_y;
  camera.p_.cx = (p_.cx + 0.5) * factor_x - 0.5;
  camera.p_.cy = (p_.cy + 0.5) * factor_y - 0.5;
  return camera;
}

}  // namespace parkade
