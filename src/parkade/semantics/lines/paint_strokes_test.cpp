// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/lines/paint_strokes.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/core.hpp>

#include "parkade/types/semantic_class.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {
namespace {

constexpr double kScale = 0.04;  // m per px

cv::Mat floorOf(int size) {
  return {size, size, CV_8UC1, cv::Scalar(static_cast<int>(SemanticClass::kFloor))};
}

void paint(cv::Mat& labels, const cv::Rect& where, SemanticClass c) {
  labels(where).setTo(static_cast<int>(c));
}

SemanticClass at(const cv::Mat& labels, int v, int u) {
  return static_cast<SemanticClass>(labels.at<std::uint8_t>(v, u));
}

TEST(PaintStrokes, AStrokesEndTakesItsClass) {
  cv::Mat labels = floorOf(128);
  paint(labels, {60, 10, 3, 100}, SemanticClass::kSlotLine);
  paint(labels, {60, 95, 3, 15}, SemanticClass::kLaneLine);  // 0.6 m of it
  paint(labels, {60, 10, 3, 6}, SemanticClass::kArrow);
  uniteStrokes(labels, kScale);
  for (int v = 10; v < 110; ++v) EXPECT_EQ(at(labels, v, 61), SemanticClass::kSlotLine) << v;
  EXPECT_EQ(at(labels, 61, 58), SemanticClass::kFloor);
}

TEST(PaintStrokes, OtherThingsStayWhatTheyAre) {
  cv::Mat labels = floorOf(128);
  paint(labels, {60, 10, 3, 100}, SemanticClass::kSlotLine);
  paint(labels, {70, 10, 3, 15}, SemanticClass::kLaneLine);    // touches nothing
  paint(labels, {20, 110, 100, 8}, SemanticClass::kStopLine);  // large
  paint(labels, {63, 40, 4, 8}, SemanticClass::kVehicle);      // no paint
  paint(labels, {50, 60, 10, 4}, SemanticClass::kWheelStop);   // stands on the floor
  const cv::Mat before = labels.clone();
  uniteStrokes(labels, kScale);
  EXPECT_EQ(cv::countNonZero(labels != before), 0);
}

// A T of two strokes, and an arrow with a head, all labelled arrow; doubt: log-odds by which slot
// line is the less likely.
cv::Mat strokesAndArrow(double doubt, cv::Mat& slot_line) {
  cv::Mat labels = floorOf(128);
  paint(labels, {20, 20, 4, 60}, SemanticClass::kArrow);
  paint(labels, {24, 48, 30, 4}, SemanticClass::kArrow);
  paint(labels, {90, 40, 4, 50}, SemanticClass::kArrow);
  for (int v = 0; v < 24; ++v) {
    const int half = 1 + v / 2;
    paint(labels, {92 - half, 18 + v, 2 * half, 1}, SemanticClass::kArrow);
  }
  paint(labels, {94, 80, 20, 3}, SemanticClass::kSlotLine);
  slot_line = cv::Mat(labels.size(), CV_8UC1, cv::Scalar(255.0 - kEvidencePerLogOdds * doubt));
  return labels;
}

TEST(PaintStrokes, AHeadlessArrowIsSlotLines) {
  cv::Mat slot_line;
  cv::Mat labels = strokesAndArrow(3.0, slot_line);
  tellStrokesFromArrows(slot_line, kScale, labels);
  EXPECT_EQ(at(labels, 30, 21), SemanticClass::kSlotLine);
  EXPECT_EQ(at(labels, 49, 40), SemanticClass::kSlotLine);
  EXPECT_EQ(at(labels, 60, 91), SemanticClass::kArrow);  // has a head
  EXPECT_EQ(at(labels, 38, 88), SemanticClass::kArrow);
}

// Labels of which the network is sure, and those of a network without slot lines.
void expectUnchanged(void (*tell)(const cv::Mat&, double, cv::Mat&), const cv::Mat& slot_line,
                     const cv::Mat& before) {
  cv::Mat labels = before.clone();
  tell(slot_line, kScale, labels);
  EXPECT_EQ(cv::countNonZero(labels != before), 0);
  tell(cv::Mat(), kScale, labels);
  EXPECT_EQ(cv::countNonZero(labels != before), 0);
}

TEST(PaintStrokes, WhatTheNetworkIsSureOfStaysAnArrow) {
  cv::Mat slot_line;
  const cv::Mat before = strokesAndArrow(6.0, slot_line);
  expectUnchanged(tellStrokesFromArrows, slot_line, before);
}

// A slot's corner whose side is labelled lane line, and a lane line by itself.
cv::Mat cornerAndLane(double doubt, cv::Mat& slot_line) {
  cv::Mat labels = floorOf(128);
  paint(labels, {20, 20, 4, 40}, SemanticClass::kSlotLine);
  paint(labels, {25, 20, 60, 4}, SemanticClass::kLaneLine);
  paint(labels, {20, 90, 60, 4}, SemanticClass::kLaneLine);
  slot_line = cv::Mat(labels.size(), CV_8UC1, cv::Scalar(255.0 - kEvidencePerLogOdds * doubt));
  return labels;
}

TEST(PaintStrokes, LaneLinesThatTouchASlotAreSlotLines) {
  cv::Mat slot_line;
  cv::Mat labels = cornerAndLane(3.0, slot_line);
  tellSlotsFromLanes(slot_line, kScale, labels);
  EXPECT_EQ(at(labels, 21, 80), SemanticClass::kSlotLine);
  EXPECT_EQ(at(labels, 91, 40), SemanticClass::kLaneLine);  // touches none
}

TEST(PaintStrokes, LaneLinesMakeNoT) {
  cv::Mat labels = floorOf(128);
  paint(labels, {20, 20, 4, 16}, SemanticClass::kLaneLine);
  paint(labels, {24, 26, 40, 4}, SemanticClass::kLaneLine);
  paint(labels, {20, 90, 60, 4}, SemanticClass::kLaneLine);
  const cv::Mat slot_line(labels.size(), CV_8UC1, cv::Scalar(255.0 - kEvidencePerLogOdds * 2.0));
  tellSlotsFromLanes(slot_line, kScale, labels);
  EXPECT_EQ(at(labels, 27, 50), SemanticClass::kSlotLine);
  EXPECT_EQ(at(labels, 22, 21), SemanticClass::kSlotLine);
  EXPECT_EQ(at(labels, 91, 40), SemanticClass::kLaneLine);
}

TEST(PaintStrokes, LaneLinesOfWhichTheNetworkIsSureStay) {
  cv::Mat slot_line;
  const cv::Mat before = cornerAndLane(5.0, slot_line);
  expectUnchanged(tellSlotsFromLanes, slot_line, before);
}

}  // namespace
}  // namespace parkade
