// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "parkade/camera/radtan.hpp"

namespace parkade {

/// Unified omnidirectional camera (Mei and Rives, ICRA 2007), as CamOdoCal's MEI and Kalibr's
/// omni-radtan define it: onto the unit sphere, from there to a plane seen from xi behind it:
///
///     s = p / |p|,   m = (s_x, s_y) / (s_z + xi),
///     (u, v) = (gamma1 m'_x + u0, gamma2 m'_y + v0),   m' = distort(m)
///
/// Valid while s_z > -min(xi, 1 / xi) and |m| is below the radius where the distortion folds back.
class Mei {
 public:
  static constexpr const char* kName = "omni-radtan";

  struct Parameters {
    double xi = 1.0;      ///< 0: pinhole, 1: stereographic; >= 0
    double gamma1 = 1.0;  ///< px
    double gamma2 = 1.0;  ///< px
    double u0 = 0.0;      ///< px; the centre of the top left pixel is (0, 0)
    double v0 = 0.0;      ///< px
    RadtanDistortion distortion;

    /// Why these values describe no camera; empty where they do.
    [[nodiscard]] std::string problem() const;
  };

  Mei() : Mei(Parameters{}) {}
  explicit Mei(const Parameters& parameters);  ///< without problem(), else it throws

  bool project(const Eigen::Vector3d& p_cam, Eigen::Vector2d& pixel,
               Eigen::Matrix<double, 2, 3>* d_px_d_p = nullptr) const {
    const double norm = p_cam.norm();
    if (!(p_cam.z() > min_cosine_ * norm)) return false;
    const double inverse = 1.0 / (p_cam.z() + p_.xi * norm);
    const Eigen::Vector2d m(p_cam.x() * inverse, p_cam.y() * inverse);
    if (!(m.squaredNorm() <= max_radius_squared_)) return false;
    const Eigen::Vector2d f(p_.gamma1, p_.gamma2);
    if (d_px_d_p == nullptr) {
      pixel = f.cwiseProduct(p_.distortion.distort(m)) + Eigen::Vector2d(p_.u0, p_.v0);
      return true;
    }
    Eigen::Matrix2d d_distorted_d_m;
    pixel =
        f.cwiseProduct(p_.distortion.distort(m, &d_distorted_d_m)) + Eigen::Vector2d(p_.u0, p_.v0);
    // m = (x, y) / D with D = z + xi |p|, so d m = ((I2 0) - m dD) / D, dD = (0 0 1) + xi p / |p|.
    Eigen::RowVector3d d_denominator = p_cam.transpose() * (p_.xi / norm);
    d_denominator.z() += 1.0;
    Eigen::Matrix<double, 2, 3> d_m_d_p = -m * d_denominator;
    d_m_d_p(0, 0) += 1.0;
    d_m_d_p(1, 1) += 1.0;
    *d_px_d_p = f.asDiagonal() * d_distorted_d_m * d_m_d_p * inverse;
    return true;
  }

  bool unproject(const Eigen::Vector2d& pixel, Eigen::Vector3d& ray_cam) const;

  [[nodiscard]] double maxAngle() const { return std::acos(min_cosine_); }
  [[nodiscard]] double focalLength() const { return 0.5 * (p_.gamma1 + p_.gamma2) / (1.0 + p_.xi); }
  /// For an image that is factor_x times as wide and factor_y times as high.
  [[nodiscard]] Mei scaled(double factor_x, double factor_y) const;
  [[nodiscard]] const Parameters& parameters() const { return p_; }

 private:
  Parameters p_;
  double max_radius_squared_ = 0.0;
  double min_cosine_ = 0.0;  // of the largest angle
};

}  // namespace parkade
