// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/rig_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

const std::vector<Eigen::Vector3d> kPlaces = {
    {3.7, 0.0, 0.6}, {2.0, 0.9, 1.0}, {2.0, -0.9, 1.0}, {-0.9, 0.0, 0.9}};

// Rigs whose cameras are placed at random: the share that fits their growth best is as uncertain.
TEST(RigError, LengthsErrAsTheBestFittingGrowth) {
  constexpr double kSigma = 0.01;
  Random random(5);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& place : kPlaces) middle += 0.25 * place;
  double sum2 = 0.0;
  constexpr int kRigs = 20000;
  for (int k = 0; k < kRigs; ++k) {
    double along = 0.0;
    double size2 = 0.0;
    for (const Eigen::Vector3d& place : kPlaces) {
      const Eigen::Vector3d off(random.normal(0.0, kSigma), random.normal(0.0, kSigma),
                                random.normal(0.0, kSigma));
      along += off.dot(place - middle);
      size2 += (place - middle).squaredNorm();
    }
    sum2 += std::pow(along / size2, 2);
  }
  const Eigen::MatrixXd covariance = kSigma * kSigma * Eigen::MatrixXd::Identity(12, 12);
  EXPECT_NEAR(lengthSigma(kPlaces, covariance), std::sqrt(sum2 / kRigs), 5e-5);
}

TEST(RigError, CamerasThatMoveTogetherChangeNoLength) {
  Eigen::MatrixXd covariance(12, 12);
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) covariance(i, j) = i % 3 == j % 3 ? 1e-4 : 0.0;
  }
  EXPECT_NEAR(lengthSigma(kPlaces, covariance), 0.0, 1e-9);
  EXPECT_EQ(lengthSigma({kPlaces[0]}, 1e-4 * Eigen::MatrixXd::Identity(3, 3)), 0.0);
}

// Turns about each axis: what all cameras have in common is their mean.
TEST(RigError, CommonTurnIsTheMeanOfAllTurns) {
  const Eigen::MatrixXd apart = 4e-6 * Eigen::MatrixXd::Identity(12, 12);
  EXPECT_TRUE(commonTurnSigma(apart).isApprox(Eigen::Vector3d::Constant(1e-3), 1e-12));
  Eigen::MatrixXd alike(12, 12);
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) alike(i, j) = i % 3 == j % 3 ? 4e-6 : 0.0;
  }
  EXPECT_TRUE(commonTurnSigma(alike).isApprox(Eigen::Vector3d::Constant(2e-3), 1e-12));
  EXPECT_EQ(commonTurnSigma(Eigen::MatrixXd(0, 0)).norm(), 0.0);
}

Eigen::Matrix3d placeCovariance(const RigErrorOnWay& error, const SE3& T_world_vehicle) {
  PoseEstimate estimate;
  estimate.T_odom_vehicle = T_world_vehicle;
  error.addTo(estimate);
  return estimate.covariance.topLeftCorner<3, 3>();
}

TEST(RigError, LengthsErrAlongTheWayFromTheStart) {
  RigErrorOnWay error;
  const SE3 end(SO3::fromYawPitchRoll(0.5 * M_PI, 0.0, 0.0), {30.0, 40.0, 0.0});
  error.advance(SE3(), SE3(), {0.002, {0.0, 0.0, 0.0}});
  error.advance(end, end, {0.002, {0.0, 0.0, 0.0}});
  const Eigen::Matrix3d P = placeCovariance(error, end);
  // Ahead is y of the frame, left is -x.
  EXPECT_NEAR(P(0, 0), std::pow(0.08, 2), 1e-12);
  EXPECT_NEAR(P(1, 1), std::pow(0.06, 2), 1e-12);
  EXPECT_NEAR(P(0, 1), -0.08 * 0.06, 1e-12);
  EXPECT_EQ(P(2, 2), 0.0);
}

TEST(RigError, TurnsErrAcrossTheWay) {
  RigErrorOnWay error;
  const SE3 end(SO3(), {10.0, 0.0, 0.0});
  error.advance(SE3(), SE3(), {});
  error.advance(end, end, {0.0, {3e-3, 2e-3, 1e-3}});
  const Eigen::Matrix3d P = placeCovariance(error, end);
  EXPECT_NEAR(P(0, 0), 0.0, 1e-15);
  EXPECT_NEAR(P(1, 1), 1e-4, 1e-12);
  EXPECT_NEAR(P(2, 2), 4e-4, 1e-12);
}

TEST(RigError, WhatIsLearnedLaterDoesNotMendTheWayBefore) {
  RigErrorOnWay error;
  const SE3 far(SO3(), {20.0, 0.0, 0.0});
  error.advance(SE3(), SE3(), {});
  error.advance(far, far, {0.003, {0.0, 0.0, 0.0}});
  EXPECT_NEAR(placeCovariance(error, far)(0, 0), std::pow(0.06, 2), 1e-12);
  error.advance(SE3(), SE3(), {0.001, {0.0, 0.0, 0.0}});  // and back
  EXPECT_NEAR(placeCovariance(error, SE3())(0, 0), std::pow(0.04, 2), 1e-12);
}

}  // namespace
}  // namespace parkade
