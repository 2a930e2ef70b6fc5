// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "parkade/geometry/so3.hpp"

namespace parkade {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// A rigid motion T_target_source: p_target = T_target_source * p_source. Tangent: (translation,
/// rotation), metres and radians, applied on the right: T * exp(xi).
/// Formulas: Sola et al., "A micro Lie theory", 2018, eqs. (171) to (182).
class SE3 {
 public:
  SE3() : translation_(Eigen::Vector3d::Zero()) {}
  SE3(const SO3& rotation, const Eigen::Vector3d& translation)
      : rotation_(rotation), translation_(translation) {}
  /// The upper 3x3 block must be a rotation to about 1e-6 (checked), the last row 0 0 0 1.
  explicit SE3(const Eigen::Matrix4d& m);

  static SE3 exp(const Vector6d& xi);
  [[nodiscard]] Vector6d log() const;

  [[nodiscard]] SE3 inverse() const;
  SE3 operator*(const SE3& other) const {
    return {rotation_ * other.rotation_, rotation_ * other.translation_ + translation_};
  }
  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return rotation_ * p + translation_; }

  [[nodiscard]] const SO3& rotation() const { return rotation_; }
  [[nodiscard]] const Eigen::Vector3d& translation() const { return translation_; }
  SO3& rotation() { return rotation_; }
  Eigen::Vector3d& translation() { return translation_; }
  [[nodiscard]] Eigen::Matrix4d matrix() const;

  /// T * exp(xi) * T^-1 = exp(adjoint() * xi)
  [[nodiscard]] Matrix6d adjoint() const;
  /// exp(xi + d) ~ exp(xi) * exp(rightJacobian(xi) * d)
  static Matrix6d rightJacobian(const Vector6d& xi);
  static Matrix6d rightJacobianInverse(const Vector6d& xi);
  /// exp(xi + d) ~ exp(leftJacobian(xi) * d) * exp(xi)
  static Matrix6d leftJacobian(const Vector6d& xi);
  static Matrix6d leftJacobianInverse(const Vector6d& xi);

 private:
  SO3 rotation_;
  Eigen::Vector3d translation_;
};

/// Between two poses: translation linearly, rotation along the geodesic; ratio 0 gives a, 1 gives
/// b.
SE3 interpolate(const SE3& a, const SE3& b, double ratio);

}  // namespace parkade
