// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/fusion/odometry.hpp"

#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "parkade/core/units.hpp"
#include "parkade/geometry/test_support.hpp"

namespace parkade {
namespace {

PoseEstimate estimateAt(double t, const SE3& T) {
  PoseEstimate e;
  e.t_ns = static_cast<TimeNs>(t * kNsPerSecond);
  e.T_odom_vehicle = T;
  e.health = Health::kTracking;
  return e;
}

TEST(Odometry, PlanarPartOfATiltedMotion) {
  const PoseEstimate a = estimateAt(0.0, {SO3::fromYawPitchRoll(0.3, 0.02, -0.01), {1, 2, 0.1}});
  const PoseEstimate b = estimateAt(0.1, {SO3::fromYawPitchRoll(0.5, -0.01, 0.03), {2, 3, 0.3}});
  const PlanarIncrement d = planarIncrement(a, b, {});
  EXPECT_NEAR(d.T_before_after.angle(), 0.2, 1e-12);
  EXPECT_NEAR(d.dz, 0.2, 1e-12);
  const SE2 end = SE2(0.3, {1, 2}) * d.T_before_after;
  EXPECT_LT((end.translation() - Eigen::Vector2d(2, 3)).norm(), 1e-12);
  const SE3 lifted = liftPose(end, 0.3, b.T_odom_vehicle);
  EXPECT_THAT(lifted.matrix(), testing::EigenMatrixNear(b.T_odom_vehicle.matrix(), 1e-12));
}

TEST(Odometry, CovarianceIsTheFloorOrTheGrowth) {
  PoseEstimate a = estimateAt(0.0, SE3());
  PoseEstimate b = estimateAt(0.1, SE3(SO3(), {1.0, 0.0, 0.0}));
  const OdometryNoiseOptions options;
  Eigen::Matrix4d Q = planarIncrement(a, b, options).covariance;
  EXPECT_NEAR(std::sqrt(Q(0, 0)), options.translation, 1e-4);
  // The odometry says more: its growth counts, by the share.
  b.covariance(1, 1) = 0.01;
  Q = planarIncrement(a, b, options).covariance;
  EXPECT_NEAR(Q(1, 1), options.told_share * 0.01, 1e-6);
  EXPECT_NEAR(std::sqrt(Q(0, 0)), options.translation, 1e-4);
  // It says less than before: never below the floor.
  std::swap(a.covariance, b.covariance);
  Q = planarIncrement(a, b, options).covariance;
  const double least = std::pow(options.yaw_deg * kDegree, 2.0);  // a metre's, the smallest there
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(Q).eigenvalues().minCoeff(),
            0.999 * least);
  b.health = Health::kLost;
  EXPECT_GT(planarIncrement(a, b, options).covariance(0, 0), 20.0 * Q(0, 0));
}

TEST(Odometry, WhereItIsLostAllOfItsGrowthCounts) {
  const PoseEstimate a = estimateAt(0.0, SE3());
  PoseEstimate b = estimateAt(0.1, SE3(SO3(), {1.0, 0.0, 0.0}));
  b.covariance(1, 1) = 0.04;
  b.health = Health::kLost;
  EXPECT_NEAR(planarIncrement(a, b, {}).covariance(1, 1), 0.04, 1e-4);
}

}  // namespace
}  // namespace parkade
