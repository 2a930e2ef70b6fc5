// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/guide_text.hpp"

#include <gtest/gtest.h>

namespace parkade {
namespace {

TEST(GuideText, MeaningsAndReadingsAreInverse) {
  for (const char* meaning : {"exit_left", "exit_right", "exit_straight", "parking_left",
                              "parking_straight", "lift_right", "EXIT"}) {
    EXPECT_EQ(guideMeaning(guideReading(meaning)), meaning);
  }
  EXPECT_EQ(guideReading("exit_left"), "<EXIT");
  EXPECT_EQ(guideReading("parking_straight"), "P^");
  EXPECT_EQ(guideMeaning("TAXI>"), "taxi_right");
  // An arrow may stand on either side.
  EXPECT_EQ(guideMeaning("EXIT<"), "exit_left");
}

TEST(GuideText, WhatIsNoSignMeansNothing) {
  for (const char* reading : {"<", "^", "<EXIT>", "EX>IT", "<<P", ""}) {
    EXPECT_EQ(guideMeaning(reading), "") << reading;
  }
}

}  // namespace
}  // namespace parkade
