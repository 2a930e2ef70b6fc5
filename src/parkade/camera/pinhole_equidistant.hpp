// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>

namespace parkade {

/// Fisheye camera after Kannala and Brandt (PAMI 2006), as OpenCV's fisheye module and Kalibr's
/// "equidistant" define it: with theta the angle from the optical axis,
///
///     d(theta) = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
///     (u, v) = (fx d x / r + cx, fy d y / r + cy),   r = sqrt(x^2 + y^2),   theta = atan2(r, z)
///
/// Valid up to the angle where d stops growing; that may lie beyond 90 degrees.
class PinholeEquidistant {
 public:
  static constexpr const char* kName = "pinhole-equidistant";

  struct Parameters {
    double fx = 1.0;  ///< px per radian at the centre
    double fy = 1.0;
    double cx = 0.0;  ///< px; the centre of the top left pixel is (0, 0)
    double cy = 0.0;
    double k1 = 0.0;
    double k2 = 0.0;
    double k3 = 0.0;
    double k4 = 0.0;

    /// Why these values describe no camera; empty where they do.
    [[nodiscard]] std::string problem() const;
  };

  PinholeEquidistant() : PinholeEquidistant(Parameters{}) {}
  explicit PinholeEquidistant(const Parameters& parameters);  ///< without problem(), else it throws

  bool project(const Eigen::Vector3d& p_cam, Eigen::Vector2d& pixel,
               Eigen::Matrix<double, 2, 3>* d_px_d_p = nullptr) const {
    const double x = p_cam.x();
    const double y = p_cam.y();
    const double z = p_cam.z();
    const double r2 = x * x + y * y;
    const double r = std::sqrt(r2);
    // So close to the axis, the distortion and the arc tangent change nothing in double precision.
    if (r <= 1e-9 * std::abs(z)) {
      if (!(z > 0.0)) return false;
      pixel = {p_.fx * x / z + p_.cx, p_.fy * y / z + p_.cy};
      if (d_px_d_p != nullptr) {
        *d_px_d_p << p_.fx / z, 0.0, -p_.fx * x / (z * z), 0.0, p_.fy / z, -p_.fy * y / (z * z);
      }
      return true;
    }
    const double theta = std::atan2(r, z);
    if (!(theta <= max_angle_)) return false;
    double slope = 0.0;
    const double d_over_r = distortedAngle(theta, slope) / r;
    pixel = {p_.fx * x * d_over_r + p_.cx, p_.fy * y * d_over_r + p_.cy};
    if (d_px_d_p != nullptr) {
      // With n = (x, y) / r: d(d n) = d' dtheta n^T + (d / r) (I - n n^T).
      const double depth_term = slope / (r2 + z * z);
      const double radial = (slope * z / (r2 + z * z) - d_over_r) / r2;
      const double mixed = radial * x * y;
      *d_px_d_p << p_.fx * (radial * x * x + d_over_r), p_.fx * mixed, -p_.fx * depth_term * x,
          p_.fy * mixed, p_.fy * (radial * y * y + d_over_r), -p_.fy * depth_term * y;
    }
    return true;
  }

  bool unproject(const Eigen::Vector2d& pixel, Eigen::Vector3d& ray_cam) const;

  [[nodiscard]] double maxAngle() const { return max_angle_; }
  [[nodiscard]] double focalLength() const { return 0.5 * (p_.fx + p_.fy); }
  /// For an image that is factor_x times as wide and factor_y times as high.
  [[nodiscard]] PinholeEquidistant scaled(double factor_x, double factor_y) const;
  [[nodiscard]] const Parameters& parameters() const { return p_; }

 private:
  // d(theta) and its derivative.
  double distortedAngle(double theta, double& slope) const {
    const double t2 = theta * theta;
    slope = 1.0 + t2 * (3.0 * p_.k1 + t2 * (5.0 * p_.k2 + t2 * (7.0 * p_.k3 + t2 * 9.0 * p_.k4)));
    return theta * (1.0 + t2 * (p_.k1 + t2 * (p_.k2 + t2 * (p_.k3 + t2 * p_.k4))));
  }

  Parameters p_;
  double max_angle_ = 0.0;
  double max_distorted_angle_ = 0.0;
};

}  // namespace parkade
