// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/geometry/so3.hpp"

#include <cmath>
#include <numbers>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

// Below this angle the series is exact to double precision and the closed form is not.
constexpr double kSmallAngle = 1e-4;

// Coefficients of hat(phi) and hat(phi)^2 in the left Jacobian: (1 - cos a)/a^2, (a - sin a)/a^3.
struct JacobianCoefficients {
  double first;
  double second;
};

JacobianCoefficients jacobianCoefficients(double angle) {
  const double a2 = angle * angle;
  if (angle < kSmallAngle) return {0.5 - a2 / 24.0, 1.0 / 6.0 - a2 / 120.0};
  const double half_sine = std::sin(0.5 * angle);
  // a - sin(a) cancels for moderate angles; the series keeps its digits up to about 0.5 rad.
  const double a4 = a2 * a2;
  const double second =
      angle < 0.3 ? 1.0 / 6.0 - a2 / 120.0 + a4 / 5040.0 - a4 * a2 / 362880.0 + a4 * a4 / 39916800.0
                  : (angle - std::sin(angle)) / (a2 * angle);
  return {2.0 * half_sine * half_sine / a2, second};
}

// Coefficient of hat(phi)^2 in the inverse Jacobians: 1/a^2 - (1 + cos a) / (2 a sin a).
double inverseJacobianCoefficient(double angle) {
  const double a2 = angle * angle;
  if (angle < 1e-2) return 1.0 / 12.0 + a2 / 720.0 + a2 * a2 / 30240.0;
  const double half = 0.5 * angle;
  return (1.0 - half * std::cos(half) / std::sin(half)) / a2;
}

}  // namespace

Eigen::Matrix3d hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Vector3d vee(const Eigen::Matrix3d& m) {
  return {m(2, 1), m(0, 2), m(1, 0)};
}

SO3::SO3(const Eigen::Matrix3d& m) {
  const double deviation = (m * m.transpose() - Eigen::Matrix3d::Identity()).norm();
  PARKADE_CHECK(deviation < 1e-5 && m.determinant() > 0.0,
                "not a rotation matrix: |R R' - I| = {}, det = {}", deviation, m.determinant());
  q_ = Eigen::Quaterniond(m).normalized();
}

SO3 SO3::exp(const Eigen::Vector3d& phi) {
  const double angle2 = phi.squaredNorm();
  const double angle = std::sqrt(angle2);
  const double scale = angle < kSmallAngle ? 0.5 - angle2 / 48.0 : std::sin(0.5 * angle) / angle;
  const Eigen::Vector3d v = scale * phi;
  return fromUnit(Eigen::Quaterniond(std::cos(0.5 * angle), v.x(), v.y(), v.z()).normalized());
}

Eigen::Vector3d SO3::log() const {
  const double sign = q_.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * q_.vec();
  const double w = sign * q_.w();
  const double sine = v.norm();
  if (sine < kSmallAngle) {
    const double ratio = sine / w;
    return 2.0 / w * (1.0 - ratio * ratio / 3.0) * v;
  }
  return 2.0 * std::atan2(sine, w) / sine * v;
}

SO3 SO3::fromYawPitchRoll(double yaw, double pitch, double roll) {
  return SO3(Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX())));
}

Eigen::Vector3d SO3::yawPitchRoll() const {
  const Eigen::Matrix3d m = matrix();
  return {std::atan2(m(1, 0), m(0, 0)), std::atan2(-m(2, 0), std::hypot(m(2, 1), m(2, 2))),
          std::atan2(m(2, 1), m(2, 2))};
}

double SO3::yaw() const {
  const Eigen::Vector3d x = q_ * Eigen::Vector3d::UnitX();
  return std::atan2(x.y(), x.x());
}

SO3 SO3::fromTwoVectors(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  PARKADE_CHECK(a.norm() > 0.0 && b.norm() > 0.0, "a direction of length zero");
  return SO3(Eigen::Quaterniond::FromTwoVectors(a, b));
}

Eigen::Matrix3d SO3::leftJacobian(const Eigen::Vector3d& phi) {
  const auto [first, second] = jacobianCoefficients(phi.norm());
  const Eigen::Matrix3d h = hat(phi);
  return Eigen::Matrix3d::Identity() + first * h + second * h * h;
}

Eigen::Matrix3d SO3::rightJacobian(const Eigen::Vector3d& phi) {
  return leftJacobian(-phi);
}

Eigen::Matrix3d SO3::leftJacobianInverse(const Eigen::Vector3d& phi) {
  const Eigen::Matrix3d h = hat(phi);
  return Eigen::Matrix3d::Identity() - 0.5 * h + inverseJacobianCoefficient(phi.norm()) * h * h;
}

Eigen::Matrix3d SO3::rightJacobianInverse(const Eigen::Vector3d& phi) {
  return leftJacobianInverse(-phi);
}

double angleBetween(const SO3& a, const SO3& b) {
  return (a.inverse() * b).log().norm();
}

double wrapAngle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? wrapped + 2.0 * std::numbers::pi : wrapped;
}

}  // namespace parkade
