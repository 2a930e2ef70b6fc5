// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/charts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace parkade {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<ChartLine> kWays = {{"fused", {{0.0, 0.0}, {20.0, 0.0}, {20.0, 10.0}}, false},
                                      {"truth", {{0.0, 0.1}, {20.0, 0.1}, {20.0, 10.0}}, true}};

TEST(Charts, GroundHasThePictureBelowAndTheTruthFirst) {
  const GroundPicture ground{"data:,x", {-5.0, 15.0}, {30.0, 20.0}};
  const std::string text = groundChart("a way", ground, kWays, {{"7", {3.0, 3.0}}});
  EXPECT_THAT(text, HasSubstr("href=\"data:,x\""));
  const std::size_t picture = text.find("<image");
  const std::size_t truth = text.find("<polyline class=\"ref\"");
  const std::size_t estimate = text.find("<polyline class=\"l0\"");
  EXPECT_LT(picture, truth);
  EXPECT_LT(truth, estimate);
  EXPECT_NE(estimate, std::string::npos);
  EXPECT_THAT(text, HasSubstr(">fused</text>"));
  EXPECT_THAT(text, HasSubstr(">7</text>"));
}

TEST(Charts, AWholePictureIsTheViewWhereverTheWaysAre) {
  GroundPicture ground{"data:,x", {-5.0, 15.0}, {30.0, 20.0}};
  ground.whole = true;
  // 30 by 20 m on 432 pixels of width.
  const std::string text =
      groundChart("a way", ground, {{"far", {{90.0, 0.0}, {99.0, 0.0}}, false}});
  EXPECT_THAT(text, HasSubstr("width=\"432\" height=\"288\""));
}

TEST(Charts, GroundHasEqualAxes) {
  // 20 m across and 10 m up with 6 m around: 32 by 22 m on 432 pixels of width.
  const std::string text = groundChart("a way", std::nullopt, kWays);
  EXPECT_THAT(text, HasSubstr("width=\"432\" height=\"297\""));
}

TEST(Charts, EmptyInputIsAPictureAllTheSame) {
  EXPECT_THAT(groundChart("none", std::nullopt, {}), HasSubstr("</svg>"));
  EXPECT_THAT(lineChart("none", "time", {}), HasSubstr("</svg>"));
  EXPECT_THAT(lineChart("one", "time", {{"a", {{1.0, 0.0}}, false}}), HasSubstr("</svg>"));
  EXPECT_THAT(barChart("none", {}), HasSubstr("</svg>"));
}

TEST(Charts, BarsAreToScale) {
  const std::string text = barChart("times", {{"a", 10.0, 20.0, "10"}, {"b", 5.0, -1.0, "5"}});
  EXPECT_THAT(text, HasSubstr("width=\"134\""));  // half of 480 - 120 - 92
  EXPECT_THAT(text, HasSubstr("width=\"67\""));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace parkade
