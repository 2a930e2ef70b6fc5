// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_text_parting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "parkade/semantics/texts/zone_text_reader.hpp"
#include "parkade/semantics/texts/zone_text_share.hpp"

namespace parkade {
namespace {

// A reader that gives a text this probability; every letter may be any other one as well.
SequenceLikelihood lettersOf(const std::string& text, double probability) {
  const std::string alphabet = kZoneLetters;
  const int steps = 2 * static_cast<int>(text.size()) + 1;
  cv::Mat logits(static_cast<int>(alphabet.size()) + 1, steps, CV_32F, cv::Scalar(-30.0));
  logits.row(0).setTo(0.0);
  const double each = std::pow(probability, 1.0 / static_cast<double>(text.size()));
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int step = 2 * static_cast<int>(i) + 1;
    const double rest = (1.0 - each) / static_cast<double>(alphabet.size() - 1);
    logits.col(step).setTo(std::log(rest));
    logits.at<float>(0, step) = -30.0F;
    const int channel = static_cast<int>(alphabet.find(text[i])) + 1;
    logits.at<float>(channel, step) = static_cast<float>(std::log(each));
  }
  return {logits, alphabet};
}

FaceLook look(const SequenceLikelihood& letters) {
  return {letters, ZoneTextReader::readingsOf(letters)};
}

FaceLooks face(const std::string& text, double probability) {
  return {look(lettersOf(text, probability))};
}

FaceLooks plain() {
  return face("", 1.0);
}

using Faces = std::vector<FaceLooks>;

std::string told(const Faces& one, const Faces& two) {
  return tellText({one, two}).readings.front().text;
}

TEST(ZoneTextShare, CountsEveryWayToShowAText) {
  EXPECT_NEAR(shareOf("B7", lettersOf("B7", 0.9)), 0.9, 0.02);
  EXPECT_NEAR(shareOf("B7", lettersOf("B7B7", 0.9)), 1.0, 0.02);  // and as if misread besides
  EXPECT_GT(shareOf("B7", lettersOf("7B7", 0.9)), 0.8);
  EXPECT_GT(shareOf("E04", lettersOf("4E04E", 0.9)), 0.8);
  EXPECT_NEAR(shareOf("E04", lettersOf("E04E10", 0.9)), 0.3, 0.05);
  EXPECT_NEAR(shareOf("C07", lettersOf("07C0", 0.9)), 0.3, 0.05);
  EXPECT_LT(shareOf("8A", lettersOf("8", 0.9)), 0.12);
  EXPECT_LT(shareOf("B7", lettersOf("H3", 0.9)), 1e-3);
  EXPECT_EQ(shareOf("", lettersOf("", 1.0)), 0.0);
}

TEST(ZoneTextShare, OddNamesAreUnlikely) {
  for (const char* name : {"A4", "12B", "C-8", "E04"}) EXPECT_EQ(nameOdds(name), 1.0) << name;
  for (const char* name : {"07C", "-8", "C-", "A4A4", "A1B2"})
    EXPECT_LT(nameOdds(name), 0.1) << name;
  EXPECT_LT(nameOdds("17"), nameOdds("B17"));
}

TEST(ZoneTextParting, OneFaceThatAnEdgeCuts) {
  // Parts are read more surely than the whole.
  EXPECT_EQ(told({face("8A", 0.7)}, {face("8", 0.92), face("A", 0.8)}), "8A");
  EXPECT_EQ(told({face("D-3", 0.5)}, {plain(), face("-3", 0.95)}), "D-3");
  EXPECT_FALSE(isSettled({face("8", 0.99), face("A", 0.99)}));
  EXPECT_FALSE(isSettled({}));
}

TEST(ZoneTextParting, TwoFacesTakenForOne) {
  for (const char* text : {"B7B7", "7B7", "B7B"}) {
    EXPECT_EQ(told({face(text, 0.95)}, {face("B7", 0.5), plain()}), "B7") << text;
  }
  EXPECT_EQ(told({face("5A5A", 0.97)}, {face("5A5", 0.97)}), "5A");
  EXPECT_EQ(told({face("7C7C", 0.95)}, {face("C7C", 0.96), face("7", 0.4)}), "7C");
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
  EXPECT_FALSE(isSettled({face("07C", 0.95)}));
  EXPECT_FALSE(isSettled({plain()}));
}

TEST(ZoneTextParting, OtherwiseTheSurerCounts) {
  EXPECT_EQ(told({face("A4", 0.8)}, {face("14", 0.6), plain()}), "A4");
  EXPECT_EQ(told({face("A4", 0.5)}, {face("H3", 0.6), plain()}), "H3");
  EXPECT_EQ(told({plain()}, {plain()}), "");
}

TEST(ZoneTextParting, ALookBelowTheFaceShowsIt) {
  FaceLooks looks = plain();
  looks.push_back(look(lettersOf("1", 0.3)));
  looks.back().down = -8;
  looks.push_back(look(lettersOf("F-6", 0.9)));
  looks.back().down = 16;
  looks.back().odds = 0.8;
  const SightText told = tellText({{looks}});
  EXPECT_EQ(told.readings.front().text, "F-6");
  EXPECT_EQ(told.down, std::vector<int>{16});
}

}  // namespace
}  // namespace parkade
