// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_text_parting.hpp"

#include <gtest/gtest.h>

namespace parkade {
namespace {

std::vector<TextReading> face(const std::string& text, double probability) {
  return {{text, probability}, {"", 0.5 * (1.0 - probability)}};
}

std::vector<TextReading> plain() {
  return {{"", 0.9}, {"1", 0.05}};
}

TEST(ZoneTextParting, OneFaceThatAnEdgeCuts) {
  // Parts are read more surely than the whole.
  EXPECT_TRUE(showsOneFace({face("8A", 0.7)}, {face("8", 0.92), face("A", 0.8)}, false));
  EXPECT_TRUE(showsOneFace({face("D-3", 0.5)}, {plain(), face("-3", 0.95)}, false));
  EXPECT_FALSE(isSettled({face("8", 0.99), face("A", 0.99)}, false));
  EXPECT_FALSE(isSettled({face("8", 0.99)}, false));
}

TEST(ZoneTextParting, TwoFacesTakenForOne) {
  for (const char* text : {"B7B7", "7B7", "B7B", "B77", "BB7"}) {
    EXPECT_FALSE(showsOneFace({face(text, 0.95)}, {face("B7", 0.5), plain()}, true)) << text;
  }
  EXPECT_FALSE(showsOneFace({face("B7", 0.9)}, {face("B7", 0.4), face("B7", 0.5)}, true));
  EXPECT_FALSE(isSettled({face("7B7", 0.99)}, true));
}

TEST(ZoneTextParting, ATextThatStandsTwiceIsTheText) {
  const std::vector<TextReading> once =
      onceEach({{"A-9", 0.3}, {"A-9A-9", 0.5}, {"11", 0.1}, {"A-9A", 0.05}, {"", 0.01}});
  ASSERT_EQ(once.size(), 4U);
  EXPECT_EQ(once[0].text, "A-9");
  EXPECT_NEAR(once[0].probability, 0.8, 1e-12);
  EXPECT_EQ(once[1].text, "11");
  EXPECT_EQ(once[2].text, "A-9A");
  EXPECT_EQ(once[3].text, "");
}

TEST(ZoneTextParting, WhatIsSureAndWholeIsSettled) {
  EXPECT_TRUE(isSettled({face("A11", 0.95)}, true));
  EXPECT_TRUE(isSettled({face("C-8", 0.95), face("C-8", 0.6)}, false));
  EXPECT_FALSE(isSettled({face("A11", 0.8)}, true));
  EXPECT_FALSE(isSettled({plain()}, true));
}

TEST(ZoneTextParting, OtherwiseTheSurerCounts) {
  EXPECT_TRUE(showsOneFace({face("A4", 0.8)}, {face("14", 0.6), plain()}, false));
  EXPECT_FALSE(showsOneFace({face("A4", 0.5)}, {face("H3", 0.6), plain()}, true));
  EXPECT_TRUE(showsOneFace({plain()}, {}, true));
  EXPECT_FALSE(showsOneFace({{{"", 1.0}}}, {{{"", 1.0}}, {{"", 1.0}}}, false));
}

}  // namespace
}  // namespace parkade
