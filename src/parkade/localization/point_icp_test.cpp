// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/point_icp.hpp"

#include <gmock/gmock.h>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

// Lines of a few slots, an arrow and a bump, as points; noise of each point, m.
PointCloud scene(const SE2& T, double noise, std::uint64_t seed) {
  Random random(seed);
  PointCloud cloud(0.1);
  const auto line = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b, PointKind kind) {
    const int count = static_cast<int>((b - a).norm() / 0.04);
    for (int i = 0; i <= count; ++i) {
      const Eigen::Vector2d e(noise * random.normal(), noise * random.normal());
      cloud.add({T * (a + (b - a) * i / count + e), kind});
    }
  };
  for (int i = 0; i < 5; ++i) line({2.5 * i, 3.0}, {2.5 * i, 8.0}, PointKind::kLine);
  line({0.0, 8.0}, {10.0, 8.0}, PointKind::kLine);
  line({4.0, 0.0}, {6.0, 0.2}, PointKind::kGuideSign);
  line({8.0, -2.0}, {8.0, 2.0}, PointKind::kBump);
  return cloud;
}

TEST(PointIcp, FindsTheMotionToWithinACell) {
  const SE2 truth(0.03, {0.25, -0.2});
  const PointIcpResult r =
      registerPoints(scene(SE2(), 0.0, 1), scene(truth, 0.0, 1), SE2(), PointIcpOptions());
  ASSERT_TRUE(r.accepted);
  // Evenly thinned points of lines fit as well one point further along: within a cell, no better.
  EXPECT_LT((r.T_target_source.translation() - truth.translation()).norm(), 0.12);
  EXPECT_NEAR(r.T_target_source.angle(), truth.angle(), 0.012);
}

TEST(PointIcp, AveragesNoise) {
  const SE2 truth(-0.02, {-0.2, 0.15});
  const PointIcpResult r =
      registerPoints(scene(SE2(), 0.03, 2), scene(truth, 0.03, 3), SE2(), PointIcpOptions());
  ASSERT_TRUE(r.accepted);
  EXPECT_LT((r.T_target_source.translation() - truth.translation()).norm(), 0.04);
}

TEST(PointIcp, RefusesWhatDoesNotFit) {
  PointCloud other(0.1);
  Random random(5);
  for (int i = 0; i < 400; ++i) {
    other.add({{random.uniform(0.0, 10.0), random.uniform(-2.0, 8.0)}, PointKind::kLine});
  }
  EXPECT_FALSE(registerPoints(scene(SE2(), 0.0, 1), other, SE2(), PointIcpOptions()).accepted);
  EXPECT_FALSE(
      registerPoints(PointCloud(), scene(SE2(), 0.0, 1), SE2(), PointIcpOptions()).accepted);
}

TEST(PointCloud, NearestIsOfTheKindAndTheNearest) {
  Random random(7);
  PointCloud cloud(0.1);
  for (int i = 0; i < 500; ++i) {
    cloud.add({{random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0)},
               static_cast<PointKind>(random.integer(0, 2))});
  }
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d p(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0));
    int best = -1;
    double least = 0.8;
    for (std::size_t k = 0; k < cloud.points().size(); ++k) {
      if (cloud.points()[k].kind != PointKind::kLine) continue;
      const double d = (cloud.points()[k].p - p).norm();
      if (d < least) {
        least = d;
        best = static_cast<int>(k);
      }
    }
    EXPECT_EQ(cloud.nearest(p, PointKind::kLine, 0.8), best);
  }
}

}  // namespace
}  // namespace parkade
