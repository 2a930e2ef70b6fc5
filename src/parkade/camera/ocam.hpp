// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace parkade {

/// Polynomial omnidirectional camera (Scaramuzza, Martinelli, Siegwart, IROS 2006; the OCamCalib
/// toolbox). With r = sqrt(x^2 + y^2) and the toolbox's angle t = atan2(-z, r), which is -90 deg on
/// the optical axis:
///
///     rho(t) = w_0 + w_1 t + w_2 t^2 + ...                 ("world2cam", the toolbox's invpol)
///     (u, v) = A (x, y) rho / r + (cx, cy)                 x right and y down, as in all models
///
/// The toolbox counts (row, column) and turns the camera frame accordingly; its affine c, d, e and
/// centre xc, yc become A = [1 e; d c], cx = yc, cy = xc: see fromToolbox().
///
/// Two deviations make the model consistent (docs/math/cameras.md). The toolbox fits a second
/// polynomial for rays, z = a_0 + a_1 rho + ... ("cam2world"), which agrees with the first only as
/// far as that fit goes. Here un-projection is the exact inverse of projection: Newton's method on
/// world2cam, for which cam2world is just the start. And rho(-90 deg), some thousandths of a pixel
/// where it should be 0, is blended away over the innermost 0.1 rad, so that the axis meets the
/// centre.
///
/// Valid up to the angle where rho stops growing.
class Ocam {
 public:
  static constexpr const char* kName = "ocam";
  static constexpr int kMaxCoefficients = 24;
  /// Largest |rho(-90 deg)| that blending can hide.
  static constexpr double kMaxCentreOffset = 1.0;  ///< px

  struct Parameters {
    std::vector<double> world2cam = {50.0 * std::numbers::pi, 100.0};  ///< w_0, w_1, ...; px
    std::vector<double> cam2world;  ///< a_0, a_1, ...; may be empty
    Eigen::Matrix2d affine = Eigen::Matrix2d::Identity();
    double cx = 0.0;  ///< px; the centre of the top left pixel is (0, 0)
    double cy = 0.0;  ///< px

    /// Why these values describe no camera; empty where they do.
    [[nodiscard]] std::string problem() const;
  };

  /// From the values of the toolbox's calib_results.txt (C and C++ version: indices from 0).
  static Parameters fromToolbox(const std::vector<double>& pol, const std::vector<double>& invpol,
                                double xc, double yc, double c, double d, double e);

  Ocam() : Ocam(Parameters{}) {}
  explicit Ocam(const Parameters& parameters);  ///< without problem(), else it throws

  bool project(const Eigen::Vector3d& p_cam, Eigen::Vector2d& pixel,
               Eigen::Matrix<double, 2, 3>* d_px_d_p = nullptr) const {
    const double x = p_cam.x();
    const double y = p_cam.y();
    const double z = p_cam.z();
    const double r2 = x * x + y * y;
    const double r = std::sqrt(r2);
    if (r <= 1e-9 * std::abs(z)) {
      if (!(z > 0.0)) return false;
      const double f = focal_at_axis_ / z;
      pixel = affine_ * Eigen::Vector2d(f * x, f * y) + center_;
      if (d_px_d_p != nullptr) {
        d_px_d_p->leftCols<2>() = f * affine_;
        d_px_d_p->col(2) = affine_ * Eigen::Vector2d(-f * x / z, -f * y / z);
      }
      return true;
    }
    const double theta = std::atan2(r, z);
    if (!(theta <= max_angle_)) return false;
    double slope = 0.0;
    const double rho_over_r = radius(theta, slope) / r;
    pixel = affine_ * Eigen::Vector2d(x * rho_over_r, y * rho_over_r) + center_;
    if (d_px_d_p != nullptr) {
      const double inverse_norm2 = 1.0 / (r2 + z * z);
      const double radial = (slope * z * inverse_norm2 - rho_over_r) / r2;
      const double depth_term = -slope * inverse_norm2;
      Eigen::Matrix<double, 2, 3> d_metric_d_p;
      d_metric_d_p << radial * x * x + rho_over_r, radial * x * y, depth_term * x,  //
          radial * x * y, radial * y * y + rho_over_r, depth_term * y;
      *d_px_d_p = affine_ * d_metric_d_p;
    }
    return true;
  }

  bool unproject(const Eigen::Vector2d& pixel, Eigen::Vector3d& ray_cam) const;

  [[nodiscard]] double maxAngle() const { return max_angle_; }
  [[nodiscard]] double focalLength() const {
    return 0.5 * focal_at_axis_ * (affine_.row(0).norm() + affine_.row(1).norm());
  }
  /// For an image that is factor_x times as wide and factor_y times as high.
  [[nodiscard]] Ocam scaled(double factor_x, double factor_y) const;
  [[nodiscard]] Parameters parameters() const;

 private:
  static constexpr double kBlendAngle = 0.1;  // rad
  struct Polynomial {
    std::array<double, kMaxCoefficients> coefficients{};
    int size = 0;
    // The value, and the derivative in slope.
    double operator()(double argument, double& slope) const {
      double value = 0.0;
      slope = 0.0;
      for (int i = size - 1; i >= 0; --i) {
        slope = slope * argument + value;
        value = value * argument + coefficients[static_cast<std::size_t>(i)];
      }
      return value;
    }
  };
  static Polynomial toPolynomial(const std::vector<double>& coefficients);

  // rho in px at theta from the optical axis, and d rho / d theta.
  double radius(double theta, double& slope) const {
    double rho = world2cam_(theta - 0.5 * std::numbers::pi, slope);
    if (theta < kBlendAngle) {
      const double weight = 1.0 - theta / kBlendAngle;
      rho -= center_offset_ * weight * weight;
      slope += 2.0 * center_offset_ * weight / kBlendAngle;
    }
    return rho;
  }

  Polynomial world2cam_;
  Polynomial cam2world_;
  Eigen::Matrix2d affine_ = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d affine_inverse_ = Eigen::Matrix2d::Identity();
  Eigen::Vector2d center_ = Eigen::Vector2d::Zero();
  double center_offset_ = 0.0;  // the polynomial's rho on the axis, px
  double focal_at_axis_ = 0.0;  // d rho / d theta on the axis, px/rad
  double max_angle_ = 0.0;
  double max_radius_ = 0.0;  // rho there
};

}  // namespace parkade
