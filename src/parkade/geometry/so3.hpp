// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace parkade {

/// The skew-symmetric matrix of v: hat(v) * w = v x w.
Eigen::Matrix3d hat(const Eigen::Vector3d& v);
/// The vector of a skew-symmetric matrix: vee(hat(v)) = v.
Eigen::Vector3d vee(const Eigen::Matrix3d& m);

/// A rotation in space, as a unit quaternion (Hamilton). R_target_source turns vectors of the
/// source frame into the target frame. Tangent: rotation vector in radians, applied on the right:
/// R * exp(phi). Formulas: Sola et al., "A micro Lie theory", 2018, eqs. (132) to (149).
class SO3 {
 public:
  SO3() : q_(Eigen::Quaterniond::Identity()) {}
  /// The quaternion is normalised.
  explicit SO3(const Eigen::Quaterniond& q) : q_(q.normalized()) {}
  /// m must be a rotation matrix to about 1e-6 (checked); it is orthonormalised.
  explicit SO3(const Eigen::Matrix3d& m);

  static SO3 exp(const Eigen::Vector3d& phi);
  [[nodiscard]] Eigen::Vector3d log() const;  ///< angle in [0, pi]

  /// Z-Y-X angles: R = Rz(yaw) * Ry(pitch) * Rx(roll), radians.
  static SO3 fromYawPitchRoll(double yaw, double pitch, double roll);
  [[nodiscard]] Eigen::Vector3d yawPitchRoll() const;
  [[nodiscard]] double yaw() const;

  /// The shortest rotation that turns direction a into direction b (neither is zero).
  static SO3 fromTwoVectors(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

  [[nodiscard]] SO3 inverse() const { return fromUnit(q_.conjugate()); }
  SO3 operator*(const SO3& other) const { return fromUnit((q_ * other.q_).normalized()); }
  Eigen::Vector3d operator*(const Eigen::Vector3d& v) const { return q_ * v; }

  [[nodiscard]] Eigen::Matrix3d matrix() const { return q_.toRotationMatrix(); }
  [[nodiscard]] const Eigen::Quaterniond& quaternion() const { return q_; }
  [[nodiscard]] Eigen::Matrix3d adjoint() const { return matrix(); }

  /// exp(phi + d) ~ exp(phi) * exp(rightJacobian(phi) * d)
  static Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& phi);
  static Eigen::Matrix3d rightJacobianInverse(const Eigen::Vector3d& phi);
  /// exp(phi + d) ~ exp(leftJacobian(phi) * d) * exp(phi)
  static Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& phi);
  static Eigen::Matrix3d leftJacobianInverse(const Eigen::Vector3d& phi);

 private:
  static SO3 fromUnit(const Eigen::Quaterniond& q) {
    SO3 r;
    r.q_ = q;
    return r;
  }
  Eigen::Quaterniond q_;
};

/// Angle between two rotations, radians in [0, pi].
double angleBetween(const SO3& a, const SO3& b);

/// Wraps an angle into (-pi, pi].
double wrapAngle(double angle);

}  // namespace parkade
