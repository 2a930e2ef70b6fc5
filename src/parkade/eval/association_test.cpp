// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/association.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "parkade/eval/test_support.hpp"

namespace parkade {
namespace {

using ::testing::HasSubstr;

Trajectory at(const std::vector<double>& seconds) {
  Trajectory trajectory;
  for (const double t : seconds) {
    trajectory.push_back({fromSeconds(t), SE3(SO3(), {t, 0.0, 0.0})});
  }
  return trajectory;
}

std::vector<TimeNs> stamps(const Trajectory& trajectory) {
  std::vector<TimeNs> result;
  for (const auto& pose : trajectory) result.push_back(pose.t_ns);
  return result;
}

std::vector<TimeNs> ns(const std::vector<double>& seconds) {
  return stamps(at(seconds));
}

TEST(Association, TakesTheNearestWithinTheTolerance) {
  const auto pairs = associate(at({1.004, 2.0, 3.02, 4.0}), at({1.0, 1.9, 2.009, 3.0, 4.01, 5.0}));
  ASSERT_TRUE(pairs.ok());
  EXPECT_EQ(stamps(pairs->estimate), ns({1.004, 2.0, 4.0}));
  EXPECT_EQ(stamps(pairs->reference), ns({1.0, 2.009, 4.01}));
  EXPECT_EQ(pairs->estimate_poses, 4u);
  EXPECT_EQ(pairs->reference_poses, 6u);
  EXPECT_NEAR(pairs->mean_difference_s, (0.004 + 0.009 + 0.01) / 3.0, 1e-9);
}

TEST(Association, TheShorterAsksWhicheverItIs) {
  const Trajectory dense = at({1.0, 1.005, 1.01, 1.015, 1.02});
  const Trajectory sparse = at({1.004, 1.016});
  const auto one = associate(sparse, dense);
  const auto other = associate(dense, sparse);
  ASSERT_TRUE(one.ok() && other.ok());
  EXPECT_EQ(stamps(one->reference), ns({1.005, 1.015}));
  EXPECT_EQ(stamps(other->estimate), ns({1.005, 1.015}));
}

TEST(Association, UsesEveryPoseOnce) {
  // Both 1.000 and 1.004 are nearest to 1.003: the nearer of them gets it.
  const auto pairs = associate(at({1.0, 1.004}), at({0.9, 1.003, 1.1}));
  ASSERT_TRUE(pairs.ok());
  EXPECT_EQ(stamps(pairs->estimate), ns({1.004}));
  EXPECT_EQ(stamps(pairs->reference), ns({1.003}));
}

TEST(Association, ToleranceIsInclusive) {
  AssociationOptions options;
  options.tolerance_s = 0.02;
  EXPECT_EQ(associate(at({1.0}), at({1.02}), options)->size(), 1u);
  EXPECT_FALSE(associate(at({1.0}), at({1.020001}), options).ok());
}

TEST(Association, InterpolatesTheReference) {
  Trajectory reference = at({0.0, 1.0, 2.0, 10.0, 11.0});
  reference[1].T_world_body = SE3(SO3::fromYawPitchRoll(0.4, 0.0, 0.0), {1.0, 0.0, 0.0});
  AssociationOptions options;
  options.interpolate = true;
  // -0.1 and 11.1 lie outside, 5.0 in a hole of 8 s; 2.0 is a stamp of both.
  const auto pairs = associate(at({-0.1, 0.25, 2.0, 5.0, 10.5, 11.1}), reference, options);
  ASSERT_TRUE(pairs.ok());
  EXPECT_EQ(stamps(pairs->estimate), ns({0.25, 2.0, 10.5}));
  EXPECT_EQ(stamps(pairs->reference), ns({0.25, 2.0, 10.5}));
  EXPECT_NEAR(pairs->reference[0].T_world_body.translation().x(), 0.25, 1e-12);
  EXPECT_NEAR(pairs->reference[0].T_world_body.rotation().yaw(), 0.1, 1e-12);
  EXPECT_EQ(pairs->mean_difference_s, 0.0);
}

TEST(Association, OffsetMovesTheEstimate) {
  AssociationOptions options;
  options.offset_s = -99.5;
  const auto pairs = associate(at({100.5, 101.5}), at({1.0, 2.0, 3.0}), options);
  ASSERT_TRUE(pairs.ok());
  EXPECT_EQ(stamps(pairs->estimate), ns({1.0, 2.0}));
}

TEST(Association, CoverageIsTheShareOfTheReferencesTime) {
  const Trajectory reference = testing::straight(101, 0.1, 0);  // 0 to 10 s
  EXPECT_DOUBLE_EQ(associate(reference, reference)->coverage, 1.0);

  // Starts 2 s late and loses 3 s in between: 10 - 2 - 3 = 5 s.
  Trajectory estimate;
  for (const auto& pose : reference) {
    const double t = toSeconds(pose.t_ns);
    if (t < 1.95 || (t > 4.05 && t < 6.95)) continue;
    estimate.push_back(pose);
  }
  EXPECT_NEAR(associate(estimate, reference)->coverage, 0.5, 1e-9);

  // What the reference does not know counts neither way.
  EXPECT_NEAR(associate(reference, estimate)->coverage, 1.0, 1e-9);

  // A fifth of the rate, and beyond both ends: everything is covered.
  const Trajectory slow = testing::straight(30, 0.5, -1'000'000'000);
  EXPECT_DOUBLE_EQ(associate(slow, reference)->coverage, 1.0);

  // A single common instant.
  EXPECT_DOUBLE_EQ(associate(at({1.0}), at({1.0}))->coverage, 1.0);
  EXPECT_DOUBLE_EQ(associate(at({1.0}), reference)->coverage, 0.0);
}

TEST(Association, SlowTrajectoriesHaveNoHoles) {
  // Key frames every 2 s: the pause counts by the trajectory's own step.
  std::vector<double> seconds;
  for (int i = 0; i <= 20; ++i) seconds.push_back(2.0 * i);
  EXPECT_DOUBLE_EQ(associate(at(seconds), at(seconds))->coverage, 1.0);
}

TEST(Association, SaysWhyNothingMatches) {
  const auto apart = associate(at({100.0, 101.0}), at({1.0, 2.0}));
  ASSERT_FALSE(apart.ok());
  EXPECT_THAT(apart.error().message, HasSubstr("from 100.000 s to 101.000 s (2 poses)"));
  EXPECT_THAT(apart.error().message, HasSubstr("from 1.000 s to 2.000 s (2 poses)"));
  EXPECT_THAT(apart.error().message, HasSubstr("--offset -99.000"));

  const auto between = associate(at({1.05, 1.15}), at({1.0, 1.1, 1.2}));
  ASSERT_FALSE(between.ok());
  EXPECT_THAT(between.error().message, HasSubstr("0.050000 s apart"));
  EXPECT_THAT(between.error().message, HasSubstr("--tolerance"));

  AssociationOptions options;
  options.interpolate = true;
  Trajectory holed = at({0.0, 0.1, 0.2, 0.3, 9.0, 9.1});
  const auto hole = associate(at({5.0}), holed, options);
  ASSERT_FALSE(hole.ok());
  EXPECT_THAT(hole.error().message, HasSubstr("--max-gap"));

  EXPECT_THAT(associate({}, at({1.0})).error().message, HasSubstr("estimate holds no pose"));
  EXPECT_THAT(associate(at({1.0}), {}).error().message, HasSubstr("reference holds no pose"));
}

TEST(Association, RefusesDisorder) {
  EXPECT_THROW(static_cast<void>(associate(at({2.0, 1.0}), at({1.0}))), CheckError);
}

TEST(Association, PathLength) {
  EXPECT_NEAR(pathLength(testing::straight(11)), 10.0, 1e-12);
  EXPECT_EQ(pathLength({}), 0.0);
}

}  // namespace
}  // namespace parkade
