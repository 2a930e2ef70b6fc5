// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/camera/ocam.hpp"

#include <fmt/core.h>

#include <Eigen/LU>
#include <algorithm>

#include "parkade/camera/solve_monotonic.hpp"
#include "parkade/core/check.hpp"

namespace parkade {

Ocam::Parameters Ocam::fromToolbox(const std::vector<double>& pol,
                                   const std::vector<double>& invpol, double xc, double yc,
                                   double c, double d, double e) {
  Parameters parameters;
  parameters.world2cam = invpol;
  parameters.cam2world = pol;
  parameters.affine << 1.0, e, d, c;
  parameters.cx = yc;
  parameters.cy = xc;
  return parameters;
}

Ocam::Polynomial Ocam::toPolynomial(const std::vector<double>& coefficients) {
  Polynomial polynomial;
  polynomial.size = static_cast<int>(std::min<std::size_t>(coefficients.size(), kMaxCoefficients));
  std::copy_n(coefficients.begin(), polynomial.size, polynomial.coefficients.begin());
  return polynomial;
}

std::string Ocam::Parameters::problem() const {
  if (world2cam.size() < 2 || world2cam.size() > kMaxCoefficients) {
    return fmt::format("world2cam has {} coefficients, expected 2 to {}", world2cam.size(),
                       kMaxCoefficients);
  }
  if (cam2world.size() > kMaxCoefficients) {
    return fmt::format("cam2world has {} coefficients, expected at most {}", cam2world.size(),
                       kMaxCoefficients);
  }
  if (!(affine.determinant() > 0.0)) {
    return fmt::format("the affine part has determinant {}, expected > 0", affine.determinant());
  }
  double slope = 0.0;
  const double offset = toPolynomial(world2cam)(-0.5 * std::numbers::pi, slope);
  if (!(std::abs(offset) <= kMaxCentreOffset)) {
    return fmt::format("world2cam gives {} px on the optical axis, expected 0 to within {} px",
                       offset, kMaxCentreOffset);
  }
  if (!(slope > 2.0 * kMaxCentreOffset / kBlendAngle)) {
    return fmt::format("world2cam grows by {} px/rad on the optical axis, expected a focal length",
                       slope);
  }
  return {};
}

Ocam::Ocam(const Parameters& parameters)
    : world2cam_(toPolynomial(parameters.world2cam)),
      cam2world_(toPolynomial(parameters.cam2world)),
      affine_(parameters.affine),
      affine_inverse_(parameters.affine.inverse()),
      center_(parameters.cx, parameters.cy) {
  PARKADE_CHECK(parameters.problem().empty(), "{}", parameters.problem());
  double slope = 0.0;
  center_offset_ = world2cam_(-0.5 * std::numbers::pi, slope);
  radius(0.0, focal_at_axis_);
  max_angle_ = growingRange(
      [this](double theta) {
        double slope_at = 0.0;
        radius(theta, slope_at);
        return slope_at > 0.0;
      },
      kMaxFisheyeAngle);
  max_radius_ = radius(max_angle_, slope);
}

bool Ocam::unproject(const Eigen::Vector2d& pixel, Eigen::Vector3d& ray_cam) const {
  const Eigen::Vector2d m = affine_inverse_ * (pixel - center_);
  const double rho = m.norm();
  if (!(rho <= max_radius_)) return false;
  if (rho < 1e-9 * focal_at_axis_) {
    ray_cam = Eigen::Vector3d(m.x() / focal_at_axis_, m.y() / focal_at_axis_, 1.0).normalized();
    return true;
  }
  double slope = 0.0;
  const double start = cam2world_.size > 0 ? std::atan2(rho, -cam2world_(rho, slope))
                                           : std::min(rho / focal_at_axis_, max_angle_);
  const double theta = solveMonotonic([this](double t, double& s) { return radius(t, s); }, rho,
                                      0.0, max_angle_, start);
  const double sine = std::sin(theta);
  ray_cam = {sine * m.x() / rho, sine * m.y() / rho, std::cos(theta)};
  return true;
}

Ocam Ocam::scaled(double factor_x, double factor_y) const {
  Ocam camera = *this;
  camera.affine_.row(0) *= factor_x;
  camera.affine_.row(1) *= factor_y;
  camera.affine_inverse_ = camera.affine_.inverse();
  camera.center_ = {(center_.x() + 0.5) * factor_x - 0.5, (center_.y() + 0.5) * factor_y - 0.5};
  return camera;
}

Ocam::Parameters Ocam::parameters() const {
  const auto to_vector = [](const Polynomial& polynomial) {
    return std::vector<double>(polynomial.coefficients.begin(),
                               polynomial.coefficients.begin() + polynomial.size);
  };
  return {to_vector(world2cam_), to_vector(cam2world_), affine_, center_.x(), center_.y()};
}

}  // namespace parkade
