// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/paint_strokes.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/core.hpp>

#include "parkade/types/semantic_class.hpp"

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

}  // namespace
}  // namespace parkade
