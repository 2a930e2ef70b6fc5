// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/row_compass.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "parkade/core/random.hpp"
#include "parkade/core/units.hpp"

namespace parkade {
namespace {

// A drive along +x between two rows of slots. Their lines are short pieces of worn paint, each
// turned by some degrees, that end within a centimetre of the entrances at y = -3 and y = 3.
struct Rows {
  double lean_deg = 90.0;  ///< of the slots' lines against the rows
  double entrance_scatter = 0.01;
  double length = 0.8;
  Random random{7};

  SemanticFrame seenFrom(double x) {
    SemanticFrame frame;
    for (const double side : {-1.0, 1.0}) {
      for (double at = std::ceil((x - 5.0) / 2.5) * 2.5; at < x + 5.0; at += 2.5) {
        const double angle = (lean_deg + 3.0 * random.normal()) * kDegree;
        LineSegment line;
        const double before = entrance_scatter * random.normal();
        line.begin = {at - x + before, side * (3.0 + entrance_scatter * random.normal())};
        line.end = line.begin + side * length * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        frame.line_segments.push_back(line);
      }
    }
    return frame;
  }

  /// The odometry turns the world by turn, rad.
  std::optional<RowReading> drive(RowCompass& compass, double metres, double turn,
                                  double expected) {
    std::optional<RowReading> last;
    for (double x = 0.0; x <= metres; x += 1.0) {
      compass.add(seenFrom(x), SE2(turn, {0.0, 0.0}) * SE2(0.0, {x, 0.0}), x);
      if (const auto found = compass.read(expected)) last = found;
    }
    return last;
  }
};

TEST(RowCompass, ReadsTheDirectionOfRows) {
  for (const double turn : {0.0, 0.3, -0.4}) {
    for (const double quarter : {0.0, 90.0, -180.0}) {
      RowCompass compass({});
      const auto found = Rows().drive(compass, 30.0, turn * kDegree, quarter * kDegree);
      ASSERT_TRUE(found) << turn;
      EXPECT_NEAR(found->direction / kDegree, quarter + turn, 0.02);
    }
  }
}

TEST(RowCompass, ReadsRowsOfSlantedSlots) {
  RowCompass compass({});
  Rows rows;
  rows.lean_deg = 55.0;
  const auto found = rows.drive(compass, 30.0, 0.2 * kDegree, 0.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->direction / kDegree, 0.2, 0.02);
}

TEST(RowCompass, SaysNothingWhereNothingLiesInRows) {
  RowCompass compass({});
  Rows rows;
  rows.entrance_scatter = 1.0;
  EXPECT_FALSE(rows.drive(compass, 30.0, 0.0, 0.0));
  EXPECT_FALSE(Rows().drive(compass, 10.0, 0.0, 0.0)) << "too short a way";
  RowCompass turned({});
  Rows short_lines;
  short_lines.length = 0.05;
  EXPECT_FALSE(short_lines.drive(turned, 30.0, 3.0 * kDegree, 0.0)) << "beyond what is searched";
}

TEST(RowCompass, ReadingsThatDifferFromTheOneBeforeAreUnsure) {
  for (const double bend_deg : {0.0, 0.4}) {
    RowCompass compass({});
    Rows rows;
    std::vector<RowReading> readings;
    for (double x = 0.0; x <= 50.0; x += 1.0) {
      // As a line beside the car whose distance is measured ever more wrongly.
      const double turn = (x < 25.0 ? 0.0 : bend_deg) * kDegree;
      compass.add(rows.seenFrom(x),
                  SE2(0.0, {25.0, 0.0}) * SE2(turn, {0.0, 0.0}) * SE2(0.0, {x - 25.0, 0.0}), x);
      if (const auto found = compass.read(0.0)) readings.push_back(*found);
    }
    ASSERT_GE(readings.size(), 3U);
    double worst = 0.0;
    for (std::size_t i = 1; i < readings.size(); ++i) {
      worst = std::max(worst, readings[i].sigma);
      EXPECT_GE(readings[i].sigma, std::abs(readings[i].direction - readings[i - 1].direction));
    }
    if (bend_deg == 0.0) {
      EXPECT_LT(worst, 0.09 * kDegree);
    } else {
      EXPECT_GT(worst, 0.12 * kDegree);
    }
  }
}

TEST(RowCompass, ReadsOncePerSpacingAndForgets) {
  RowCompass compass({});
  Rows rows;
  int readings = 0;
  for (double x = 0.0; x <= 50.0; x += 1.0) {
    compass.add(rows.seenFrom(x), SE2(0.0, {x, 0.0}), x);
    if (compass.read(0.0)) ++readings;
  }
  EXPECT_THAT(readings, testing::AllOf(testing::Ge(7), testing::Le(8)));
  compass.forget();
  compass.add(rows.seenFrom(60.0), SE2(0.0, {60.0, 0.0}), 60.0);
  EXPECT_FALSE(compass.read(0.0));
}

}  // namespace
}  // namespace parkade
