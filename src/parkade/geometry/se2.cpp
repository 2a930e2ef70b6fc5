// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/geometry/se2.hpp"

#include <cmath>

namespace parkade {
namespace {

constexpr double kSmallTurn = 1e-3;

// sin(a)/a and (1 - cos a)/a.
Eigen::Vector2d sincCoefficients(double a) {
  if (std::abs(a) < kSmallTurn) {
    const double a2 = a * a;
    return {1.0 - a2 / 6.0 + a2 * a2 / 120.0, a * (0.5 - a2 / 24.0 + a2 * a2 / 720.0)};
  }
  return {std::sin(a) / a, (1.0 - std::cos(a)) / a};
}

// V(a) of Sola et al. eq. (158).
Eigen::Matrix2d tangentMap(double a) {
  const Eigen::Vector2d c = sincCoefficients(a);
  Eigen::Matrix2d v;
  v << c[0], -c[1], c[1], c[0];
  return v;
}

}  // namespace

SE2::SE2(double angle, const Eigen::Vector2d& translation)
    : angle_(wrapAngle(angle)), translation_(translation) {}

SE2 SE2::exp(const Eigen::Vector3d& xi) {
  return {xi.z(), tangentMap(xi.z()) * xi.head<2>()};
}

Eigen::Vector3d SE2::log() const {
  Eigen::Vector3d xi;
  xi << tangentMap(angle_).inverse() * translation_, angle_;
  return xi;
}

Eigen::Matrix2d SE2::rotationMatrix() const {
  const double c = std::cos(angle_);
  const double s = std::sin(angle_);
  Eigen::Matrix2d m;
  m << c, -s, s, c;
  return m;
}

SE2 SE2::inverse() const {
  return {-angle_, -(rotationMatrix().transpose() * translation_)};
}

SE2 SE2::operator*(const SE2& other) const {
  return {angle_ + other.angle_, rotationMatrix() * other.translation_ + translation_};
}

Eigen::Vector2d SE2::operator*(const Eigen::Vector2d& p) const {
  return rotationMatrix() * p + translation_;
}

Eigen::Matrix3d SE2::adjoint() const {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m.topLeftCorner<2, 2>() = rotationMatrix();
  m(0, 2) = translation_.y();
  m(1, 2) = -translation_.x();
  return m;
}

Eigen::Matrix3d SE2::leftJacobian(const Eigen::Vector3d& xi) {
  const double a = xi.z();
  const double a2 = a * a;
  double c1 = 0.0;  // (a - sin a) / a^2
  double c2 = 0.0;  // (1 - cos a) / a^2
  if (std::abs(a) < 0.1) {
    c1 = a * (1.0 / 6.0 - a2 / 120.0 + a2 * a2 / 5040.0 - a2 * a2 * a2 / 362880.0);
    c2 = 0.5 - a2 / 24.0 + a2 * a2 / 720.0 - a2 * a2 * a2 / 40320.0;
  } else {
    c1 = (a - std::sin(a)) / a2;
    c2 = (1.0 - std::cos(a)) / a2;
  }
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m.topLeftCorner<2, 2>() = tangentMap(a);
  m(0, 2) = c1 * xi.x() + c2 * xi.y();
  m(1, 2) = -c2 * xi.x() + c1 * xi.y();
  return m;
}

Eigen::Matrix3d SE2::rightJacobian(const Eigen::Vector3d& xi) {
  return leftJacobian(-xi);
}

SE2 SE2::fromSE3(const SE3& T) {
  return {T.rotation().yaw(), T.translation().head<2>()};
}

SE3 SE2::toSE3(double z) const {
  return {SO3::fromYawPitchRoll(angle_, 0.0, 0.0), {translation_.x(), translation_.y(), z}};
}

}  // namespace parkade
