// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "parkade/geometry/se3.hpp"

namespace parkade {

/// A rigid motion in the plane, T_target_source. Tangent: (x, y, angle), metres and radians,
/// applied on the right. Formulas: Sola et al., "A micro Lie theory", 2018, eqs. (153) to (165).
class SE2 {
 public:
  SE2() : translation_(Eigen::Vector2d::Zero()) {}
  SE2(double angle, const Eigen::Vector2d& translation);

  static SE2 exp(const Eigen::Vector3d& xi);
  [[nodiscard]] Eigen::Vector3d log() const;

  [[nodiscard]] SE2 inverse() const;
  SE2 operator*(const SE2& other) const;
  Eigen::Vector2d operator*(const Eigen::Vector2d& p) const;

  [[nodiscard]] double angle() const { return angle_; }  ///< in (-pi, pi]
  [[nodiscard]] const Eigen::Vector2d& translation() const { return translation_; }
  [[nodiscard]] Eigen::Matrix2d rotationMatrix() const;

  /// T * exp(xi) * T^-1 = exp(adjoint() * xi)
  [[nodiscard]] Eigen::Matrix3d adjoint() const;
  /// exp(xi + d) ~ exp(xi) * exp(rightJacobian(xi) * d)
  static Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& xi);
  /// exp(xi + d) ~ exp(leftJacobian(xi) * d) * exp(xi)
  static Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& xi);

  /// The planar part of a pose in space: x, y and yaw.
  static SE2 fromSE3(const SE3& T);
  /// The same motion in space, at height z, level.
  [[nodiscard]] SE3 toSE3(double z = 0.0) const;

 private:
  double angle_ = 0.0;
  Eigen::Vector2d translation_;
};

}  // namespace parkade
