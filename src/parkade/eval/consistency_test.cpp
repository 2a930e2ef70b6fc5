// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/consistency.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

using ::testing::HasSubstr;

// Quantiles of standard tables (CRC Standard Mathematical Tables), four to six digits.
TEST(ChiSquare, QuantilesOfTheTables) {
  struct Row {
    double p, dof, x;
  };
  for (const Row& row : {Row{0.95, 1, 3.8415}, Row{0.95, 2, 5.9915}, Row{0.95, 3, 7.8147},
                         Row{0.95, 6, 12.5916}, Row{0.025, 1, 0.000982069}, Row{0.975, 1, 5.02389},
                         Row{0.025, 10, 3.24697}, Row{0.975, 10, 20.4832}, Row{0.025, 60, 40.4817},
                         Row{0.975, 60, 83.2977}, Row{0.99, 100, 135.807}, Row{0.5, 2, 1.386294}}) {
    EXPECT_NEAR(chiSquareQuantile(row.p, row.dof), row.x, 5e-5 * row.x)
        << "p " << row.p << ", dof " << row.dof;
  }
}

TEST(ChiSquare, ClosedFormOfTwoDegrees) {
  for (const double x : {1e-6, 0.1, 1.0, 3.9, 4.1, 20.0, 60.0}) {
    EXPECT_NEAR(chiSquareCdf(x, 2.0), -std::expm1(-0.5 * x), 1e-14);
  }
  for (const double x : {1e-3, 0.5, 2.0, 9.0}) {
    EXPECT_NEAR(chiSquareCdf(x, 1.0), std::erf(std::sqrt(0.5 * x)), 1e-13);
  }
  EXPECT_EQ(chiSquareCdf(0.0, 3.0), 0.0);
  EXPECT_EQ(chiSquareCdf(-1.0, 3.0), 0.0);
}

TEST(ChiSquare, QuantileInvertsTheDistribution) {
  for (const double dof : {0.5, 1.0, 3.0, 15.0, 120.0, 3000.0}) {
    for (const double p : {1e-6, 0.01, 0.3, 0.5, 0.9, 0.999999}) {
      EXPECT_NEAR(chiSquareCdf(chiSquareQuantile(p, dof), dof), p, 1e-10) << dof;
    }
  }
  EXPECT_THROW(static_cast<void>(chiSquareQuantile(1.0, 3.0)), CheckError);
  EXPECT_THROW(static_cast<void>(chiSquareQuantile(0.5, 0.0)), CheckError);
}

TEST(Nees, KnownValue) {
  const Eigen::Vector2d error(2.0, 3.0);
  const Eigen::Matrix2d covariance = Eigen::Vector2d(4.0, 9.0).asDiagonal();
  EXPECT_NEAR(*nees(error, covariance), 2.0, 1e-12);
}

TEST(Nees, RefusesWhatIsNoCovariance) {
  const Eigen::Vector2d error(1.0, 1.0);
  const auto refused = [&](const Eigen::MatrixXd& covariance) {
    const auto value = nees(error, covariance);
    return value.ok() ? std::string() : value.error().message;
  };
  EXPECT_THAT(refused(Eigen::Matrix3d::Identity()), HasSubstr("3 x 3"));
  EXPECT_THAT(refused(Eigen::Matrix2d::Zero()), HasSubstr("positive definite"));
  EXPECT_THAT(refused((Eigen::Matrix2d() << 1.0, 0.5, 0.0, 1.0).finished()),
              HasSubstr("symmetric"));
  EXPECT_THAT(refused(Eigen::Matrix2d::Constant(std::nan(""))), HasSubstr("not finite"));
}

TEST(Nees, PoseErrorIsARightPerturbation) {
  const SE3 T(SO3::exp({0.3, -0.2, 1.0}), {4.0, 5.0, 6.0});
  const Vector6d xi = (Vector6d() << 0.01, -0.02, 0.03, 0.004, 0.005, -0.006).finished();
  EXPECT_LT((poseError(T, T * SE3::exp(xi)) - xi).norm(), 1e-12);
}

// Errors drawn from the covariance lie in the band; from twice its deviation, above it; from half,
// below it.
TEST(Nees, BandTellsHonestFromOverconfident) {
  const Eigen::Matrix3d root =
      (Eigen::Matrix3d() << 0.1, 0.0, 0.0, 0.05, 0.2, 0.0, 0.01, 0.02, 0.3).finished();
  const Eigen::Matrix3d covariance = root * root.transpose();
  const auto test = [&](std::uint64_t seed, double factor) {
    Random random(seed);
    std::vector<double> values;
    for (int run = 0; run < 20; ++run) {
      const Eigen::Vector3d unit(random.normal(), random.normal(), random.normal());
      values.push_back(*nees(Eigen::Vector3d(factor * root * unit), covariance));
    }
    return *neesTest(values, 3);
  };
  int inside = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    inside += test(seed, 1.0).consistent() ? 1 : 0;
    EXPECT_TRUE(test(seed, 2.0).overconfident());
    EXPECT_LT(test(seed, 0.5).mean, test(seed, 0.5).lower);
  }
  EXPECT_NEAR(inside / 400.0, 0.95, 0.03);
  const NeesTest band = test(1, 1.0);
  EXPECT_EQ(band.runs, 20u);
  EXPECT_NEAR(band.lower, 40.4817 / 20.0, 1e-4);  // chi-square of 60 degrees of freedom
  EXPECT_NEAR(band.upper, 83.2977 / 20.0, 1e-4);
}

TEST(Nees, RefusesNoRun) {
  EXPECT_FALSE(neesTest({}, 3).ok());
  EXPECT_THROW(static_cast<void>(neesTest({1.0}, 0)), CheckError);
}

// A drive round a bend whose poses are off by draws of the covariances that it tells; odom differs
// from the world, and its first pose is exact.
TEST(PoseConsistency, TellsAnHonestCovarianceFromOneTooSmall) {
  Random random(3);
  const SE3 T_world_odom(SO3::exp({0.01, -0.02, 2.0}), {5.0, -3.0, 0.2});
  const Vector6d sigma = (Vector6d() << 0.03, 0.02, 0.05, 0.002, 0.003, 0.01).finished();
  Trajectory truth;
  Trajectory estimate;
  PoseCovariances honest;
  PoseCovariances small;
  for (int i = 0; i < 3000; ++i) {
    const TimeNs t_ns = 1000 * kNsPerSecond + i * 100 * kNsPerMs;
    const double turned = 1e-3 * i;
    const SE3 T_world_vehicle =
        T_world_odom * SE3(SO3::exp({0.0, 0.0, turned}), {30.0 * std::sin(turned), 0.02 * i, 0.0});
    truth.push_back({t_ns, T_world_vehicle});
    Vector6d error = Vector6d::Zero();
    for (int k = 0; k < 6 && i > 0; ++k) error[k] = sigma[k] * random.normal();
    estimate.push_back({t_ns, T_world_odom.inverse() * T_world_vehicle * SE3::exp(-error)});
    const Matrix6d covariance = sigma.cwiseAbs2().asDiagonal();
    honest.push_back({t_ns, i > 0 ? covariance : Matrix6d::Zero()});
    small.push_back({t_ns, 0.25 * honest.back().covariance});
  }
  const Result<PoseConsistency> right = poseConsistency(estimate, honest, truth);
  ASSERT_TRUE(right.ok());
  EXPECT_EQ(right->poses, 2999u);
  EXPECT_NEAR(right->position, 3.0, 0.2);  // of 2999 draws: sigma 0.045
  EXPECT_NEAR(right->yaw, 1.0, 0.1);       // 0.026
  EXPECT_NEAR(poseConsistency(estimate, small, truth)->position, 4.0 * right->position, 1e-9);
  EXPECT_FALSE(poseConsistency(estimate, {}, truth).ok());
}

}  // namespace
}  // namespace parkade
