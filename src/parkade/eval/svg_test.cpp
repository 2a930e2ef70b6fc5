// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/svg.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace parkade::svg {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Svg, TicksAreRound) {
  EXPECT_THAT(ticks(0.0, 10.0, 5).values, ElementsAre(0.0, 2.0, 4.0, 6.0, 8.0, 10.0));
  EXPECT_EQ(ticks(0.0, 10.0, 5).decimals, 0);
  const Ticks fine = ticks(-0.13, 0.22, 6);
  EXPECT_EQ(fine.decimals, 2);
  EXPECT_NEAR(fine.values.front(), -0.1, 1e-12);
  EXPECT_NEAR(fine.values.back(), 0.2, 1e-12);
  EXPECT_EQ(std::signbit(fine.values[2]), false);  // no "-0.00"
  const Ticks wide = ticks(0.0, 4540.0, 6);
  EXPECT_THAT(wide.values, ElementsAre(0.0, 1000.0, 2000.0, 3000.0, 4000.0));
  for (double span = 1e-6; span < 1e6; span *= 1.37) {
    const auto count = ticks(0.3 * span, 1.3 * span, 6).values.size();
    EXPECT_GE(count, 3u) << span;
    EXPECT_LE(count, 11u) << span;
  }
}

TEST(Svg, RoundUp) {
  EXPECT_DOUBLE_EQ(roundUp(3.2), 4.0);
  EXPECT_DOUBLE_EQ(roundUp(0.011), 0.012);
  EXPECT_DOUBLE_EQ(roundUp(85.0), 100.0);
  EXPECT_DOUBLE_EQ(roundUp(2.0), 2.0);
}

TEST(Svg, SimplifyKeepsCornersAndDropsTheRest) {
  Points points;
  for (int i = 0; i <= 1000; ++i) points.emplace_back(0.1 * i, 0.0);
  for (int i = 1; i <= 1000; ++i) points.emplace_back(100.0, 0.1 * i);
  const Points simple = simplify(points, 0.3);
  EXPECT_LE(simple.size(), 5u);
  EXPECT_EQ(simple.front(), points.front());
  EXPECT_EQ(simple.back(), points.back());

  Points circle;
  for (int i = 0; i <= 10000; ++i) {
    const double a = 2.0 * 3.14159265358979 * i / 10000.0;
    circle.emplace_back(200.0 * std::cos(a), 200.0 * std::sin(a));
  }
  const Points polygon = simplify(circle, 0.3);
  EXPECT_LT(polygon.size(), 200u);
  // The middle of each edge lies within the tolerance (and what thinning adds) of the circle.
  for (std::size_t i = 1; i < polygon.size(); ++i) {
    EXPECT_NEAR((0.5 * (polygon[i - 1] + polygon[i])).norm(), 200.0, 0.61);
  }
}

TEST(Svg, ThinColumnsKeepsPeaks) {
  Points points;
  for (int i = 0; i < 100000; ++i) points.emplace_back(0.005 * i, i == 54321 ? 99.0 : 0.0);
  const Points thin = thinColumns(points);
  EXPECT_LE(thin.size(), 4u * 500u);
  double highest = 0.0;
  for (const auto& p : thin) highest = std::max(highest, p.y());
  EXPECT_EQ(highest, 99.0);
  for (std::size_t i = 1; i < thin.size(); ++i) EXPECT_LE(thin[i - 1].x(), thin[i].x());
}

TEST(Svg, EscapesText) {
  Document document(100, 50, "a<b", "");
  document.text({1, 2}, "R&D <\"x\">\n", "s");
  const std::string text = document.str();
  EXPECT_THAT(text, HasSubstr("<title>a&lt;b</title>"));
  EXPECT_THAT(text, HasSubstr("R&amp;D &lt;&quot;x&quot;&gt; </text>"));
  EXPECT_THAT(text, Not(HasSubstr("\"x\"")));
}

TEST(Svg, ShortensTheMiddle) {
  EXPECT_EQ(shorten("short", 10), "short");
  EXPECT_EQ(shorten("0123456789abc", 7), "012\u2026abc");
}

}  // namespace
}  // namespace parkade::svg
