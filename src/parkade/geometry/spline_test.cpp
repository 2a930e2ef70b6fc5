// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/geometry/spline.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"
#include "parkade/geometry/robust.hpp"
#include "parkade/geometry/test_support.hpp"

namespace parkade {
namespace {

using testing::EigenMatrixNear;

constexpr TimeNs kDt = kNsPerSecond / 10;

std::vector<SE3> wavyPoses(int count) {
  std::vector<SE3> poses;
  for (int i = 0; i < count; ++i) {
    const double t = 0.1 * i;
    poses.emplace_back(SO3::fromYawPitchRoll(0.8 * t, 0.2 * std::sin(t), 0.1 * std::cos(2.0 * t)),
                       Eigen::Vector3d(2.0 * t, std::sin(t), 0.1 * std::cos(t)));
  }
  return poses;
}

TEST(SplineSE3, PassesThroughItsPoses) {
  const std::vector<SE3> poses = wavyPoses(40);
  const SplineSE3 spline = SplineSE3::through(5, kDt, poses);
  EXPECT_EQ(spline.startNs(), 5);
  EXPECT_EQ(spline.endNs(), 5 + 39 * kDt);
  for (int i = 0; i < 40; ++i) {
    EXPECT_THAT(spline.at(5 + i * kDt).T_world_body.matrix(),
                EigenMatrixNear(poses[i].matrix(), 1e-12));
  }
}

TEST(SplineSE3, TwoPosesAreEnough) {
  const std::vector<SE3> poses = wavyPoses(2);
  const SplineSE3 spline = SplineSE3::through(0, kDt, poses);
  EXPECT_THAT(spline.at(0).T_world_body.matrix(), EigenMatrixNear(poses[0].matrix(), 1e-13));
  EXPECT_THAT(spline.at(kDt).T_world_body.matrix(), EigenMatrixNear(poses[1].matrix(), 1e-13));
}

TEST(SplineSE3, DerivativesMatchDifferences) {
  const SplineSE3 spline = SplineSE3::through(0, kDt, wavyPoses(30));
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const double t = random.uniform(0.01, 2.89);
    constexpr double kStep = 1e-5;
    const auto before = spline.atSeconds(t - kStep);
    const auto here = spline.atSeconds(t);
    const auto after = spline.atSeconds(t + kStep);
    const double scale = 1.0 / (2.0 * kStep);
    EXPECT_THAT(
        here.velocity_world,
        EigenMatrixNear(
            (scale * (after.T_world_body.translation() - before.T_world_body.translation())).eval(),
            1e-7));
    EXPECT_THAT(
        here.acceleration_world,
        EigenMatrixNear((scale * (after.velocity_world - before.velocity_world)).eval(), 2e-4));
    EXPECT_THAT(
        here.angular_velocity_body,
        EigenMatrixNear(
            (scale *
             (before.T_world_body.rotation().inverse() * after.T_world_body.rotation()).log())
                .eval(),
            1e-7));
    EXPECT_THAT(
        here.angular_acceleration_body,
        EigenMatrixNear(
            (scale * (after.angular_velocity_body - before.angular_velocity_body)).eval(), 2e-4));
  }
}

TEST(SplineSE3, SecondDerivativesAreContinuousAtKnots) {
  const SplineSE3 spline = SplineSE3::through(0, kDt, wavyPoses(30));
  for (int knot = 1; knot < 28; ++knot) {
    const auto before = spline.at(knot * kDt - 1);
    const auto after = spline.at(knot * kDt + 1);
    EXPECT_THAT(before.acceleration_world, EigenMatrixNear(after.acceleration_world, 1e-6));
    EXPECT_THAT(before.angular_acceleration_body,
                EigenMatrixNear(after.angular_acceleration_body, 1e-6));
  }
}

TEST(SplineSE3, RefusesTimesOutside) {
  const SplineSE3 spline = SplineSE3::through(0, kDt, wavyPoses(4));
  EXPECT_THROW(static_cast<void>(spline.at(-1)), CheckError);
  EXPECT_THROW(static_cast<void>(spline.at(3 * kDt + 1)), CheckError);
  EXPECT_THROW(SplineSE3(0, kDt, wavyPoses(3)), CheckError);
}

TEST(RobustKernels, AreQuadraticNearZeroAndWeightsAreDerivatives) {
  for (const auto& kernel : {huber, cauchy, logarithmic, tukey}) {
    EXPECT_NEAR(kernel(1e-8, 2.0).rho, 1e-8, 1e-15);
    EXPECT_NEAR(kernel(1e-8, 2.0).weight, 1.0, 1e-8);
    for (const double s : {0.5, 3.9, 4.1, 30.0}) {
      const double slope = (kernel(s + 1e-6, 2.0).rho - kernel(s - 1e-6, 2.0).rho) / 2e-6;
      EXPECT_NEAR(kernel(s, 2.0).weight, slope, 1e-8) << "s = " << s;
    }
  }
  EXPECT_EQ(tukey(4.0, 2.0).weight, 0.0);
}

}  // namespace
}  // namespace parkade
