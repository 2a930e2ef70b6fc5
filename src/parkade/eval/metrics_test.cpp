// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/metrics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "parkade/eval/test_support.hpp"

namespace parkade {
namespace {

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;
using ::testing::HasSubstr;
using testing::moved;
using testing::straight;
using testing::winding;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

TEST(AbsoluteError, KnownOffsetAndTurn) {
  const Trajectory reference = winding(20);
  Trajectory estimate = reference;
  for (auto& pose : estimate) {
    pose.T_world_body = SE3(SO3::fromYawPitchRoll(0.1, 0.0, 0.0) * pose.T_world_body.rotation(),
                            pose.T_world_body.translation() + Eigen::Vector3d(3.0, 0.0, 4.0));
  }
  const AbsoluteError error = absoluteError(estimate, reference);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    EXPECT_NEAR(error.translation[i], 5.0, 1e-12);
    EXPECT_NEAR(error.rotation_deg[i], 0.1 * kDegPerRad, 1e-9);
    EXPECT_NEAR(error.heading_deg[i], 0.1 * kDegPerRad, 1e-9);
  }
}

TEST(AbsoluteError, TiltIsNoHeadingAndHeadingWraps) {
  const Trajectory reference = {{0, SE3(SO3::fromYawPitchRoll(3.1, 0.0, 0.0), {0, 0, 0})}};
  const Trajectory tilted = {{0, SE3(SO3::fromYawPitchRoll(3.1, 0.2, 0.0), {0, 0, 0})}};
  EXPECT_NEAR(absoluteError(tilted, reference).rotation_deg[0], 0.2 * kDegPerRad, 1e-9);
  EXPECT_NEAR(absoluteError(tilted, reference).heading_deg[0], 0.0, 1e-9);
  const Trajectory across = {{0, SE3(SO3::fromYawPitchRoll(-3.1, 0.0, 0.0), {0, 0, 0})}};
  EXPECT_NEAR(absoluteError(across, reference).heading_deg[0],
              (2.0 * std::numbers::pi - 6.2) * kDegPerRad, 1e-9);
}

TEST(AbsoluteError, RefusesUnpairedLists) {
  EXPECT_THROW(static_cast<void>(absoluteError(straight(3), straight(4))), CheckError);
}

TEST(RelativeError, PairsByPathFollowEvosRule) {
  // 1 m per pose, delta 2.5 m: complete at 3, 6, 9; the first 3 m only start the count.
  const Trajectory t = straight(12);
  const auto error = relativeError(t, t, {2.5, "m", false});
  ASSERT_TRUE(error.ok());
  EXPECT_EQ(error->pairs, (IndexPairs{{3, 6}, {6, 9}}));
  const auto all = relativeError(t, t, {3.0, "m", true});
  EXPECT_EQ(all->pairs.size(), 9u);
  EXPECT_EQ(all->pairs.front(), (std::pair<std::size_t, std::size_t>{0, 3}));
  // 2.5 m is 20 % away from the nearest pose: no pair.
  EXPECT_TRUE(relativeError(t, t, {2.5, "m", true})->pairs.empty());
}

TEST(RelativeError, PairsByTimeStepOverPauses) {
  Trajectory t = straight(31, 0.1);  // 3 s
  EXPECT_EQ(relativeError(t, t, {1.0, "s", false})->pairs,
            (IndexPairs{{0, 10}, {10, 20}, {20, 30}}));
  EXPECT_EQ(relativeError(t, t, {1.0, "s", true})->pairs.size(), 21u);
  for (std::size_t i = 15; i < t.size(); ++i) t[i].t_ns += 5 * kNsPerSecond;
  EXPECT_EQ(relativeError(t, t, {1.0, "s", false})->pairs, (IndexPairs{{0, 10}, {15, 25}}));
}

TEST(RelativeError, PairsByFrames) {
  const Trajectory t = straight(10);
  EXPECT_EQ(relativeError(t, t, {3.0, "f", false})->pairs, (IndexPairs{{0, 3}, {3, 6}, {6, 9}}));
  EXPECT_EQ(relativeError(t, t, {3.0, "f", true})->pairs.size(), 7u);
  EXPECT_TRUE(relativeError(t, t, {10.0, "f", false})->pairs.empty());
}

TEST(RelativeError, DoesNotSeeTheFrameButSeesScaleAndTurn) {
  Random random(1);
  const Trajectory reference = winding(400);
  const SE3 T(SO3::exp(testing::noise(random, 1.0)), testing::noise(random, 50.0));
  const auto same = relativeError(moved(reference, T), reference, {10.0, "m", false});
  EXPECT_LT(describe(same->translation).max, 1e-10);
  EXPECT_LT(describe(same->rotation_deg).max, 1e-6);

  // On a straight line 2 % of scale is 2 % of the distance between the two poses.
  const Trajectory line = straight(101);
  const auto scaled = relativeError(moved(line, SE3(), 1.02), line, {5.0, "f", false});
  EXPECT_NEAR(describe(scaled->translation).min, 0.1, 1e-12);
  EXPECT_NEAR(describe(scaled->translation).max, 0.1, 1e-12);

  // A heading that runs away by 0.001 rad per pose: 0.01 rad over ten poses.
  Trajectory turning = line;
  for (std::size_t i = 0; i < turning.size(); ++i) {
    turning[i].T_world_body.rotation() =
        SO3::fromYawPitchRoll(1e-3 * static_cast<double>(i), 0.0, 0.0);
  }
  const auto turned = relativeError(turning, line, {10.0, "f", false});
  EXPECT_NEAR(describe(turned->rotation_deg).mean, 0.01 * kDegPerRad, 1e-9);
}

TEST(RelativeError, RefusesSenselessOptions) {
  const Trajectory t = straight(10);
  EXPECT_THAT(relativeError(t, t, {0.0, "m", false}).error().message, HasSubstr("above zero"));
  EXPECT_THAT(relativeError(t, t, {1.5, "f", false}).error().message, HasSubstr("1.5 frames"));
  EXPECT_THAT(relativeError(t, t, {1.0, "km", false}).error().message, HasSubstr("'km'"));
}

TEST(Drift, ScaleErrorOnAStraightLineIsItsPercentage) {
  const Trajectory reference = straight(301);
  const Drift d = drift(moved(reference, SE3(), 1.01), reference);
  // Each sub-trajectory is one pose longer than its nominal length at most.
  EXPECT_NEAR(d.step_m, 30.0, 1e-12);
  EXPECT_NEAR(d.percent, 1.0, 0.02);
  EXPECT_GE(d.percent, 1.0);
  EXPECT_NEAR(d.deg_per_m, 0.0, 1e-9);
  EXPECT_NEAR(d.end_m, 3.0, 1e-9);
  EXPECT_NEAR(d.end_percent, 1.0, 1e-9);
}

TEST(Drift, LongPathsTakeTheHundredMetresOfKitti) {
  const Trajectory reference = straight(2001);
  const Drift d = drift(moved(reference, SE3(), 0.995), reference);
  EXPECT_EQ(d.step_m, 100.0);
  EXPECT_NEAR(d.percent, 0.5, 0.005);
  // Starts every ten poses, each with as many of 100 to 800 m as still fit.
  std::size_t expected = 0;
  for (int i = 0; i <= 2000; i += 10) {
    for (int length = 100; length <= 800; length += 100) expected += i + length < 2000 ? 1 : 0;
  }
  EXPECT_EQ(d.segments, expected);
}

TEST(Drift, ConstantOffsetIsNone) {
  Random random(2);
  const Trajectory reference = winding(500);
  const SE3 T(SO3::exp(testing::noise(random, 1.0)), testing::noise(random, 50.0));
  const Drift d = drift(moved(reference, T), reference);
  EXPECT_LT(d.percent, 1e-8);
  EXPECT_LT(d.end_m, 1e-8);
  EXPECT_GT(d.segments, 100u);
}

TEST(Drift, StandstillHasNone) {
  const Trajectory still = testing::standing(20);
  const Drift d = drift(still, still);
  EXPECT_EQ(d.segments, 0u);
  EXPECT_TRUE(std::isnan(d.percent));
  EXPECT_EQ(d.end_m, 0.0);
  EXPECT_TRUE(std::isnan(drift({}, {}).end_m));
}

}  // namespace
}  // namespace parkade
