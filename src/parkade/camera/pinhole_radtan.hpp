// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "parkade/camera/radtan.hpp"

namespace parkade {

/// Pinhole camera with radial and tangential distortion, as OpenCV and Kalibr define it:
///
///     m = (X / Z, Y / Z),   (u, v) = (fx m'_x + cx, fy m'_y + cy),   m' = distort(m)
///
/// Valid for Z > 0 and |m| up to the radius where the distortion folds back (docs/math/cameras.md).
class PinholeRadtan {
 public:
  static constexpr const char* kName = "pinhole-radtan";

  struct Parameters {
    double fx = 1.0;  ///< px
    double fy = 1.0;  ///< px
    double cx = 0.0;  ///< px; the centre of the top left pixel is (0, 0)
    double cy = 0.0;  ///< px
    RadtanDistortion distortion;

    /// Why these values describe no camera; empty where they do.
    [[nodiscard]] std::string problem() const;
  };

  PinholeRadtan() : PinholeRadtan(Parameters{}) {}
  explicit PinholeRadtan(const Parameters& parameters);  ///< without problem(), else it throws

  bool project(const Eigen::Vector3d& p_cam, Eigen::Vector2d& pixel,
               Eigen::Matrix<double, 2, 3>* d_px_d_p = nullptr) const {
    if (!(p_cam.z() > 0.0)) return false;
    const double inverse_z = 1.0 / p_cam.z();
    const Eigen::Vector2d m(p_cam.x() * inverse_z, p_cam.y() * inverse_z);
    if (!(m.squaredNorm() <= max_radius_squared_)) return false;
    const Eigen::Vector2d f(p_.fx, p_.fy);
    if (d_px_d_p == nullptr) {
      pixel = f.cwiseProduct(p_.distortion.distort(m)) + Eigen::Vector2d(p_.cx, p_.cy);
      return true;
    }
    Eigen::Matrix2d d_distorted_d_m;
    pixel =
        f.cwiseProduct(p_.distortion.distort(m, &d_distorted_d_m)) + Eigen::Vector2d(p_.cx, p_.cy);
    d_px_d_p->leftCols<2>() = f.asDiagonal() * d_distorted_d_m * inverse_z;
    d_px_d_p->col(2) = -(d_px_d_p->leftCols<2>() * m);
    return true;
  }

  bool unproject(const Eigen::Vector2d& pixel, Eigen::Vector3d& ray_cam) const;

  [[nodiscard]] double maxAngle() const { return std::atan(std::sqrt(max_radius_squared_)); }
  [[nodiscard]] double focalLength() const { return 0.5 * (p_.fx + p_.fy); }
  /// For an image that is factor_x times as wide and factor_y times as high.
  [[nodiscard]] PinholeRadtan scaled(double factor_x, double factor_y) const;
  [[nodiscard]] const Parameters& parameters() const { return p_; }

 private:
  Parameters p_;
  double max_radius_squared_ = 0.0;
};

}  // namespace parkade
