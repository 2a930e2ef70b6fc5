// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/fusion/landmark_fusion.hpp"

#include <gmock/gmock.h>

#include <Eigen/LU>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

PlacedPoint at(double x, double y, double sigma) {
  return {{x, y, 0.0}, sigma * sigma * Eigen::Matrix3d::Identity()};
}

TEST(LandmarkFusion, MatchesTheSameThingOnly) {
  const std::vector<PlacedPoint> corners = {at(0, 0, 0.02), at(2.5, 0, 0.02), at(5, 0, 0.02)};
  const std::vector<PlacedPoint> points = {
      at(0.02, 0.01, 0.01),                      // the first corner
      at(2.48, 0.0, 0.01), at(2.52, 0.0, 0.01),  // two beside the second: neither is it
      at(5.4, 0.0, 0.01), at(9.0, 0.0, 0.01)};   // too far
  const std::vector<LandmarkMatch> matches = matchLandmarks(corners, points, {});
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].semantic, 0);
  EXPECT_EQ(matches[0].key_point, 0);
  EXPECT_TRUE(matchLandmarks({}, points, {}).empty());
  EXPECT_TRUE(matchLandmarks(corners, {}, {}).empty());
}

TEST(LandmarkFusion, FusedPlaceIsBetterThanBothAndSaysSo) {
  Random random(1);
  double before = 0.0;
  double after = 0.0;
  double nees = 0.0;
  constexpr int kRounds = 2000;
  for (int k = 0; k < kRounds; ++k) {
    const auto noisy = [&](double sigma) {
      PlacedPoint point = at(0, 0, sigma);
      for (int i = 0; i < 3; ++i) point.p[i] += sigma * random.normal();
      return point;
    };
    const PlacedPoint semantic = noisy(0.03);
    const PlacedPoint fused = fuseLandmark(semantic, noisy(0.02));
    before += semantic.p.squaredNorm();
    after += fused.p.squaredNorm();
    nees += fused.p.dot(fused.covariance.inverse() * fused.p) / kRounds;
  }
  EXPECT_LT(after, 0.4 * before);
  EXPECT_NEAR(nees, 3.0, 0.2);
}

}  // namespace
}  // namespace parkade
