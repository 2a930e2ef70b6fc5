// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace parkade {

/// Radial and tangential distortion on the normalised image plane (Brown 1971; OpenCV's and
/// Kalibr's "radtan", with OpenCV's rational denominator as an extension):
///
///     a  = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6),   r^2 = x^2 + y^2
///     x' = a x + 2 p1 x y + p2 (r^2 + 2 x^2)
///     y' = a y + p1 (r^2 + 2 y^2) + 2 p2 x y
struct RadtanDistortion {
  double k1 = 0.0;
  double k2 = 0.0;
  double p1 = 0.0;
  double p2 = 0.0;
  double k3 = 0.0;
  double k4 = 0.0;
  double k5 = 0.0;
  double k6 = 0.0;

  /// d_out_d_in is 2x2 and symmetric, if asked.
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& m,
                                        Eigen::Matrix2d* d_out_d_in = nullptr) const {
    const double x = m.x();
    const double y = m.y();
    const double r2 = x * x + y * y;
    const double numerator = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double denominator = 1.0 + r2 * (k4 + r2 * (k5 + r2 * k6));
    const double a = numerator / denominator;
    if (d_out_d_in != nullptr) {
      const double d_numerator = k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3);
      const double d_denominator = k4 + r2 * (2.0 * k5 + r2 * 3.0 * k6);
      const double d_a_d_r2 = (d_numerator - a * d_denominator) / denominator;
      const double mixed = 2.0 * (x * y * d_a_d_r2 + p1 * x + p2 * y);
      (*d_out_d_in)(0, 0) = a + 2.0 * x * x * d_a_d_r2 + 2.0 * p1 * y + 6.0 * p2 * x;
      (*d_out_d_in)(0, 1) = mixed;
      (*d_out_d_in)(1, 0) = mixed;
      (*d_out_d_in)(1, 1) = a + 2.0 * y * y * d_a_d_r2 + 6.0 * p1 * y + 2.0 * p2 * x;
    }
    return {x * a + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * a + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
  }

  /// The point whose distortion is given; false where none lies within max_radius.
  bool undistort(const Eigen::Vector2d& distorted, double max_radius, Eigen::Vector2d& m) const;

  /// Radius up to which the distortion is one-to-one: where it first folds back in any direction,
  /// and at most tan(89.5 deg).
  [[nodiscard]] double oneToOneRadius() const;
};

}  // namespace parkade
