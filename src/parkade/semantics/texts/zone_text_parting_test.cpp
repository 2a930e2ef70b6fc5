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

std::string told(const FaceReadings& one, const FaceReadings& two) {
  return tellText({one, two}).readings.front().text;
}

TEST(ZoneTextParting, OneFaceThatAnEdgeCuts) {
  // Parts are read more surely than the whole.
  EXPECT_EQ(told({face("8A", 0.7)}, {face("8", 0.92), face("A", 0.8)}), "8A");
  EXPECT_EQ(told({face("D-3", 0.5)}, {plain(), face("-3", 0.95)}), "D-3");
  EXPECT_FALSE(isSettled({face("8", 0.99), face("A", 0.99)}));
  EXPECT_FALSE(isSettled({}));
}

TEST(ZoneTextParting, TwoFacesTakenForOne) {
  for (const char* text : {"B7B7", "7B7", "B7B", "B77", "BB7"}) {
    EXPECT_EQ(told({face(text, 0.95)}, {face("B7", 0.5), plain()}), "B7") << text;
  }
  EXPECT_EQ(told({face("5A5A", 0.97)}, {face("5A5", 0.97)}), "5A");
  EXPECT_EQ(told({face("7C7C", 0.95)}, {face("C7C", 0.96), face("Z", 0.4)}), "7C");
  EXPECT_EQ(told({face("05D05", 0.54)}, {face("D05D05", 0.2)}), "D05");
  EXPECT_FALSE(isSettled({face("7B7", 0.99)}));
  // The parting that shows it is told as well.
  EXPECT_EQ(tellText({{face("B7B7", 0.95)}, {face("B7", 0.5), plain()}}).parting, 0U);
  EXPECT_EQ(tellText({{face("B7B", 0.5)}, {face("B7", 0.9), face("B7", 0.9)}}).parting, 1U);
}

TEST(ZoneTextParting, FacesThatAgreeMakeItSurer) {
  const std::vector<TextReading> readings = tellText({{face("B7", 0.6), face("B7", 0.6)}}).readings;
  EXPECT_EQ(readings.front().text, "B7");
  EXPECT_GT(readings.front().probability, 0.75);
  double sum = 0.0;
  for (const TextReading& reading : readings) sum += reading.probability;
  EXPECT_LE(sum, 1.0 + 1e-12);
}

TEST(ZoneTextParting, WhatIsSureAndWholeIsSettled) {
  EXPECT_TRUE(isSettled({face("A11", 0.95)}));
  EXPECT_TRUE(isSettled({face("A11A11", 0.95)}));
  EXPECT_TRUE(isSettled({face("C-8", 0.95), face("C-8", 0.6)}));
  EXPECT_FALSE(isSettled({face("A11", 0.8)}));
  EXPECT_FALSE(isSettled({plain()}));
}

TEST(ZoneTextParting, OtherwiseTheSurerCounts) {
  EXPECT_EQ(told({face("A4", 0.8)}, {face("14", 0.6), plain()}), "A4");
  EXPECT_EQ(told({face("A4", 0.5)}, {face("H3", 0.6), plain()}), "H3");
  EXPECT_EQ(told({plain()}, {plain()}), "");
}

}  // namespace
}  // namespace parkade
