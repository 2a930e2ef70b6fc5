// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/zone_text_truth.hpp"

#include <gtest/gtest.h>

namespace parkade::cli {
namespace {

TEST(ZoneTextTruth, ReadingsWhereNoTextIsAreWrong) {
  TrueZoneText text;
  text.text = "B12";
  text.distance = 6.0;
  constexpr double kReach = 10.0;
  EXPECT_EQ(isRight("B12", &text, kReach), true);
  EXPECT_EQ(isRight("B13", &text, kReach), false);
  EXPECT_EQ(isRight("B12", nullptr, kReach), false);
  text.distance = 11.0;
  EXPECT_EQ(isRight("B13", &text, kReach), std::nullopt);
}

}  // namespace
}  // namespace parkade::cli
