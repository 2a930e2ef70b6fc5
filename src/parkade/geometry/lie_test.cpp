// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/geometry/se3.hpp"
#include "parkade/geometry/test_support.hpp"

namespace parkade {
namespace {

using testing::EigenMatrixNear;
using testing::numericJacobian;

// Identity, 1e-8, the borders of the series, moderate, near pi, and random tangents.
template <int N>
std::vector<Eigen::Matrix<double, N, 1>> tangents() {
  Random random(7);
  const auto draw = [&](double length) {
    Eigen::Matrix<double, N, 1> v;
    for (int i = 0; i < N; ++i) v[i] = random.normal();
    return Eigen::Matrix<double, N, 1>(length * v.normalized());
  };
  std::vector<Eigen::Matrix<double, N, 1>> all = {Eigen::Matrix<double, N, 1>::Zero()};
  for (const double length :
       {1e-8, 1e-5, 0.99e-4, 1.01e-4, 9e-3, 1.1e-2, 0.09, 0.11, 0.29, 0.31, 1.0, 2.5, 3.1}) {
    for (int repeat = 0; repeat < 5; ++repeat) all.push_back(draw(length));
  }
  return all;
}

TEST(SO3, HatAndVeeAreInverse) {
  const Eigen::Vector3d v(1.0, -2.0, 3.0);
  const Eigen::Vector3d w(0.3, 0.5, -0.7);
  EXPECT_THAT((hat(v) * w).eval(), EigenMatrixNear(v.cross(w).eval(), 1e-15));
  EXPECT_EQ(vee(hat(v)), v);
}

TEST(SO3, LogInvertsExp) {
  for (const Eigen::Vector3d& phi : tangents<3>()) {
    EXPECT_THAT(SO3::exp(phi).log(), EigenMatrixNear(phi, 1e-13));
  }
}

TEST(SO3, ExpMatchesRodrigues) {
  const Eigen::Vector3d phi(0.4, -1.1, 0.7);
  const Eigen::Matrix3d expected = Eigen::AngleAxisd(phi.norm(), phi.normalized()).matrix();
  EXPECT_THAT(SO3::exp(phi).matrix(), EigenMatrixNear(expected, 1e-15));
}

TEST(SO3, JacobiansMatchNumericOnes) {
  for (const Eigen::Vector3d& phi : tangents<3>()) {
    const SO3 r = SO3::exp(phi);
    const auto right = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      return (r.inverse() * SO3::exp(phi + Eigen::Vector3d(d))).log();
    };
    const auto left = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      return (SO3::exp(phi + Eigen::Vector3d(d)) * r.inverse()).log();
    };
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(3);
    EXPECT_THAT(SO3::rightJacobian(phi), EigenMatrixNear(numericJacobian(right, zero), 1e-8));
    EXPECT_THAT(SO3::leftJacobian(phi), EigenMatrixNear(numericJacobian(left, zero), 1e-8));
    const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
    EXPECT_THAT((SO3::rightJacobian(phi) * SO3::rightJacobianInverse(phi)).eval(),
                EigenMatrixNear(identity, 1e-12));
    EXPECT_THAT((SO3::leftJacobian(phi) * SO3::leftJacobianInverse(phi)).eval(),
                EigenMatrixNear(identity, 1e-12));
  }
}

TEST(SO3, YawPitchRollRoundTrip) {
  const Eigen::Vector3d ypr(2.1, -0.4, 0.9);
  const SO3 r = SO3::fromYawPitchRoll(ypr[0], ypr[1], ypr[2]);
  EXPECT_THAT(r.yawPitchRoll(), EigenMatrixNear(ypr, 1e-14));
  EXPECT_NEAR(r.yaw(), 2.1, 1e-14);
}

TEST(SO3, RefusesWhatIsNoRotation) {
  Eigen::Matrix3d mirrored = Eigen::Matrix3d::Identity();
  mirrored(2, 2) = -1.0;
  EXPECT_THROW(SO3{mirrored}, CheckError);
  EXPECT_THROW(SO3{Eigen::Matrix3d(1.01 * Eigen::Matrix3d::Identity())}, CheckError);
}

TEST(SO3, WrapAngle) {
  EXPECT_DOUBLE_EQ(wrapAngle(std::numbers::pi), std::numbers::pi);
  EXPECT_DOUBLE_EQ(wrapAngle(-std::numbers::pi), std::numbers::pi);
  EXPECT_NEAR(wrapAngle(7.0), 7.0 - 2.0 * std::numbers::pi, 1e-15);
}

TEST(SE3, LogInvertsExp) {
  for (const Vector6d& xi : tangents<6>()) {
    EXPECT_THAT(SE3::exp(xi).log(), EigenMatrixNear(xi, 1e-12));
  }
}

TEST(SE3, GroupLaws) {
  const SE3 a = SE3::exp((Vector6d() << 1, 2, 3, 0.1, -0.5, 0.9).finished());
  const SE3 b = SE3::exp((Vector6d() << -2, 0.4, 1, 1.4, 0.2, -0.3).finished());
  const Eigen::Vector3d p(0.3, -0.6, 2.0);
  EXPECT_THAT(((a * b) * p).eval(), EigenMatrixNear((a * (b * p)).eval(), 1e-14));
  EXPECT_THAT((a.inverse() * a).matrix(),
              EigenMatrixNear(Eigen::Matrix4d::Identity().eval(), 1e-14));
  EXPECT_THAT((a * b).matrix(), EigenMatrixNear((a.matrix() * b.matrix()).eval(), 1e-14));
}

TEST(SE3, AdjointMovesTangents) {
  const SE3 T = SE3::exp((Vector6d() << 1, 2, 3, 0.1, -0.5, 0.9).finished());
  for (const Vector6d& xi : tangents<6>()) {
    const SE3 moved = T * SE3::exp(xi) * T.inverse();
    EXPECT_THAT(moved.matrix(), EigenMatrixNear(SE3::exp(T.adjoint() * xi).matrix(), 1e-12));
  }
}

TEST(SE3, JacobiansMatchNumericOnes) {
  for (const Vector6d& xi : tangents<6>()) {
    const SE3 T = SE3::exp(xi);
    const auto right = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      return (T.inverse() * SE3::exp(xi + Vector6d(d))).log();
    };
    const auto left = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      return (SE3::exp(xi + Vector6d(d)) * T.inverse()).log();
    };
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(6);
    EXPECT_THAT(SE3::rightJacobian(xi), EigenMatrixNear(numericJacobian(right, zero), 1e-8));
    EXPECT_THAT(SE3::leftJacobian(xi), EigenMatrixNear(numericJacobian(left, zero), 1e-8));
    EXPECT_THAT((SE3::rightJacobian(xi) * SE3::rightJacobianInverse(xi)).eval(),
                EigenMatrixNear(Matrix6d::Identity().eval(), 1e-11));
  }
}

TEST(SE3, InterpolateMeetsBothEnds) {
  const SE3 a = SE3::exp((Vector6d() << 1, 2, 3, 0.1, -0.5, 0.9).finished());
  const SE3 b = SE3::exp((Vector6d() << -2, 0.4, 1, 1.4, 0.2, -0.3).finished());
  EXPECT_THAT(interpolate(a, b, 0.0).matrix(), EigenMatrixNear(a.matrix(), 1e-14));
  EXPECT_THAT(interpolate(a, b, 1.0).matrix(), EigenMatrixNear(b.matrix(), 1e-14));
  EXPECT_THAT(interpolate(a, b, 0.5).translation(),
              EigenMatrixNear((0.5 * (a.translation() + b.translation())).eval(), 1e-14));
}

TEST(SE2, LogInvertsExp) {
  for (const Eigen::Vector3d& xi : tangents<3>()) {
    EXPECT_THAT(SE2::exp(xi).log(), EigenMatrixNear(xi, 1e-12));
  }
}

TEST(SE2, AgreesWithSE3) {
  const SE2 a(0.7, {1.0, -2.0});
  const SE2 b(-2.9, {0.3, 0.8});
  const SE3 in_space = a.toSE3() * b.toSE3();
  EXPECT_THAT(SE2::fromSE3(in_space).log(), EigenMatrixNear((a * b).log(), 1e-13));
  EXPECT_THAT((a.inverse() * a).log(), EigenMatrixNear(Eigen::Vector3d::Zero().eval(), 1e-15));
}

TEST(SE2, JacobiansMatchNumericOnes) {
  for (const Eigen::Vector3d& xi : tangents<3>()) {
    const SE2 T = SE2::exp(xi);
    const auto right = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      return (T.inverse() * SE2::exp(xi + Eigen::Vector3d(d))).log();
    };
    const auto left = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      return (SE2::exp(xi + Eigen::Vector3d(d)) * T.inverse()).log();
    };
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(3);
    EXPECT_THAT(SE2::rightJacobian(xi), EigenMatrixNear(numericJacobian(right, zero), 1e-8));
    EXPECT_THAT(SE2::leftJacobian(xi), EigenMatrixNear(numericJacobian(left, zero), 1e-8));
    const SE2 frame(0.4, {1.0, 2.0});
    const SE2 moved = frame * T * frame.inverse();
    EXPECT_THAT((moved.inverse() * SE2::exp(frame.adjoint() * xi)).log(),
                EigenMatrixNear(Eigen::Vector3d::Zero().eval(), 1e-12));
  }
}

}  // namespace
}  // namespace parkade
