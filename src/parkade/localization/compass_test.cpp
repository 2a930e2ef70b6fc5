// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/compass.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <optional>

#include "parkade/core/random.hpp"
#include "parkade/core/units.hpp"
#include "parkade/geometry/so3.hpp"

namespace parkade {
namespace {

SemanticFrame frameOf(const std::vector<double>& directions_deg, double heading) {
  SemanticFrame frame;
  for (const double direction : directions_deg) {
    const double angle = direction * kDegree - heading;
    LineSegment segment;
    segment.end = 4.0 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    segment.sigma_heading = 0.1 * kDegree;
    frame.line_segments.push_back(segment);
  }
  return frame;
}

TEST(Compass, ReadsTheHeadingOffAxesThatItLearned) {
  Compass compass({});
  for (double way = 0.0; way < 10.0; way += 1.0) {
    EXPECT_FALSE(compass.read(frameOf({20, 110, 20}, 0.1), 0.1, way));
  }
  // Later the car looks elsewhere, and its odometry is off by a degree.
  for (const double heading : {0.3, 2.0, -2.5}) {
    const auto found = compass.read(frameOf({20, 110, 200}, heading), heading + kDegree, 20.0);
    ASSERT_TRUE(found);
    EXPECT_NEAR(wrapAngle(*found - heading), 0.0, 1e-9);
  }
  EXPECT_FALSE(compass.read(frameOf({50, 140}, 0.0), 0.0, 30.0)) << "a slanted row";
  EXPECT_FALSE(compass.read(SemanticFrame(), 0.0, 31.0));
  // One slanted line among straight ones does not bend the heading.
  const auto found = compass.read(frameOf({20, 20, 110, 55}, 0.0), 0.5 * kDegree, 32.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 0.0, 1e-9);
}

TEST(Compass, LooksAboutTheAxesAsTheyAreKnownByNow) {
  // Learned 2 degrees off; lines scatter by 2 degrees about what is true.
  Compass compass({});
  for (double way = 0.0; way < 10.0; way += 1.0) {
    EXPECT_FALSE(compass.read(frameOf({22, 112}, 0.0), 0.0, way));
  }
  const SemanticFrame scattered = frameOf({18, 20, 22, 108, 110, 112}, 0.0);
  const auto about_wrong = compass.read(scattered, 0.0, 20.0);
  ASSERT_TRUE(about_wrong);
  EXPECT_NEAR(*about_wrong / kDegree, 1.0, 1e-6) << "18 and 108 are out of its window";
  const auto about_right = compass.read(scattered, 0.0, 21.0, -2.0 * kDegree);
  ASSERT_TRUE(about_right);
  EXPECT_NEAR(*about_right / kDegree, 2.0, 1e-6) << "by the axes as learned, all alike";
}

TEST(Compass, LearnsBesideSlantedRows) {
  Compass compass({});
  for (double way = 0.0; way < 10.0; way += 1.0) {
    EXPECT_FALSE(compass.read(frameOf({20, 60, 110, 60, 20.1, 19.9}, 0.1), 0.1, way));
  }
  const auto found = compass.read(frameOf({20, 110, 60}, 0.3), 0.3 + kDegree, 10.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 0.3, 1e-9);
}

TEST(Compass, DoesNotLearnFromSlantedRowsOrWhenOff) {
  Compass compass({});
  for (double way = 0.0; way < 30.0; way += 1.0) {
    EXPECT_FALSE(compass.read(frameOf({0, 60, 60, 0}, 0.0), 0.0, way));
  }
  CompassOptions options;
  options.enable = false;
  Compass off(options);
  for (double way = 0.0; way < 30.0; way += 1.0) {
    EXPECT_FALSE(off.read(frameOf({0, 90}, 0.0), 0.0, way));
  }
}

TEST(CompassScatter, TellsReadingsThatDifferFromEachOther) {
  Random random(5);
  CompassScatter scatter(0.3 * kDegree);
  // Good lines, about half a turn off the odometry.
  for (int i = 0; i < 30; ++i) {
    const double off = wrapAngle(180.0 * kDegree + 0.05 * kDegree * random.normal());
    const std::optional<double> sigma = scatter.add(off);
    ASSERT_EQ(sigma.has_value(), i >= 3);
    if (sigma) {
      EXPECT_DOUBLE_EQ(*sigma, 0.3 * kDegree);
    }
  }
  // Worn ones.
  double sigma = 0.0;
  for (int i = 0; i < 15; ++i) {
    sigma = scatter.add(wrapAngle(180.0 * kDegree + 0.7 * kDegree * random.normal())).value();
  }
  EXPECT_GT(sigma, 5.0 * kDegree);  // they err together: not even many count
  EXPECT_LT(sigma, 40.0 * kDegree);
  scatter.forget();
  EXPECT_FALSE(scatter.add(0.0));
}

TEST(CompassScatter, TheFirstThatIsToldKnowsHowMuchReadingsScatter) {
  CompassScatter scatter(0.185 * kDegree);
  std::optional<double> first;
  // The first of a garage with a bare floor.
  for (const double off_deg : {1.0, -2.0, -0.5, 3.4}) first = scatter.add(off_deg * kDegree);
  ASSERT_TRUE(first);
  EXPECT_GT(*first, 1.5 * kDegree);
}

}  // namespace
}  // namespace parkade
