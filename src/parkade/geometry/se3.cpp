// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/geometry/se3.hpp"

#include <cmath>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

// Q(rho, phi) of the left Jacobian, Sola et al. eq. (180); Barfoot, "State Estimation for
// Robotics", eq. (7.86b).
Eigen::Matrix3d leftJacobianCoupling(const Eigen::Vector3d& rho, const Eigen::Vector3d& phi) {
  const double a = phi.norm();
  const double a2 = a * a;
  double c1 = 0.0;  // (a - sin a) / a^3
  double c2 = 0.0;  // (a^2 + 2 cos a - 2) / (2 a^4)
  double c3 = 0.0;  // (2 a - 3 sin a + a cos a) / (2 a^5)
  if (a < 0.3) {
    const double a4 = a2 * a2;
    c1 = 1.0 / 6.0 - a2 / 120.0 + a4 / 5040.0 - a4 * a2 / 362880.0 + a4 * a4 / 39916800.0;
    c2 = 1.0 / 24.0 - a2 / 720.0 + a4 / 40320.0 - a4 * a2 / 3628800.0 + a4 * a4 / 479001600.0;
    c3 = 1.0 / 120.0 - a2 / 2520.0 + a4 / 120960.0 - a4 * a2 / 9979200.0;
  } else {
    const double s = std::sin(a);
    const double c = std::cos(a);
    c1 = (a - s) / (a2 * a);
    c2 = (a2 + 2.0 * c - 2.0) / (2.0 * a2 * a2);
    c3 = (2.0 * a - 3.0 * s + a * c) / (2.0 * a2 * a2 * a);
  }
  const Eigen::Matrix3d r = hat(rho);
  const Eigen::Matrix3d p = hat(phi);
  const Eigen::Matrix3d pr = p * r;
  const Eigen::Matrix3d rp = r * p;
  const Eigen::Matrix3d prp = pr * p;
  return 0.5 * r + c1 * (pr + rp + prp) + c2 * (p * pr + rp * p - 3.0 * prp) +
         c3 * (prp * p + p * prp);
}

Matrix6d blockJacobian(const Eigen::Matrix3d& diagonal, const Eigen::Matrix3d& coupling) {
  Matrix6d m;
  m << diagonal, coupling, Eigen::Matrix3d::Zero(), diagonal;
  return m;
}

}  // namespace

SE3::SE3(const Eigen::Matrix4d& m)
    : rotation_(Eigen::Matrix3d(m.topLeftCorner<3, 3>())), translation_(m.topRightCorner<3, 1>()) {
  PARKADE_CHECK((m.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() < 1e-9,
                "last row of a homogeneous matrix is not 0 0 0 1");
}

SE3 SE3::exp(const Vector6d& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  return {SO3::exp(phi), SO3::leftJacobian(phi) * xi.head<3>()};
}

Vector6d SE3::log() const {
  const Eigen::Vector3d phi = rotation_.log();
  Vector6d xi;
  xi << SO3::leftJacobianInverse(phi) * translation_, phi;
  return xi;
}

SE3 SE3::inverse() const {
  const SO3 inverse_rotation = rotation_.inverse();
  return {inverse_rotation, -(inverse_rotation * translation_)};
}

Eigen::Matrix4d SE3::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = rotation_.matrix();
  m.topRightCorner<3, 1>() = translation_;
  return m;
}

Matrix6d SE3::adjoint() const {
  const Eigen::Matrix3d r = rotation_.matrix();
  return blockJacobian(r, hat(translation_) * r);
}

Matrix6d SE3::leftJacobian(const Vector6d& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  return blockJacobian(SO3::leftJacobian(phi), leftJacobianCoupling(xi.head<3>(), phi));
}

Matrix6d SE3::rightJacobian(const Vector6d& xi) {
  return leftJacobian(-xi);
}

Matrix6d SE3::leftJacobianInverse(const Vector6d& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  const Eigen::Matrix3d inverse = SO3::leftJacobianInverse(phi);
  return blockJacobian(inverse, -inverse * leftJacobianCoupling(xi.head<3>(), phi) * inverse);
}

Matrix6d SE3::rightJacobianInverse(const Vector6d& xi) {
  return leftJacobianInverse(-xi);
}

SE3 interpolate(const SE3& a, const SE3& b, double ratio) {
  const SO3 rotation =
      a.rotation() * SO3::exp(ratio * (a.rotation().inverse() * b.rotation()).log());
  return {rotation, a.translation() + ratio * (b.translation() - a.translation())};
}

}  // namespace parkade
