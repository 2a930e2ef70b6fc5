// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_marks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "parkade/semantics/slots/slot_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

LineSegment segment(const Vector2d& begin, const Vector2d& end) {
  LineSegment line;
  line.begin = begin;
  line.end = end;
  line.width = kLine;
  line.semantic_class = SemanticClass::kSlotLine;
  return line;
}

// Two lines of an L whose measured parts end 0.5 m before its corner at (2, -3).
std::vector<LineSegment> cornerless() {
  return {segment({1.5, -3.0}, {0.5, -3.0}), segment({2.0, -3.5}, {2.0, -5.5})};
}

int meetings(const PaintedFloor& floor) {
  int count = 0;
  for (const SlotMark& mark :
       findSlotMarks(floor.bev.image, LabelProbe(floor.labels), cornerless())) {
    if (mark.across.isZero() || mark.is_front_end) continue;
    EXPECT_LT((mark.p - Vector2d(2.0, -3.0)).norm(), 0.02);  // half a pixel
    ++count;
  }
  return count;
}

TEST(SlotMarks, LinesMeetOverPaintThatIsNotMeasured) {
  PaintedFloor floor;
  floor.line({2.0, -3.0}, {0.5, -3.0}, kLine);
  floor.line({2.0, -3.0}, {2.0, -5.5}, kLine);
  EXPECT_GT(meetings(floor), 0);
}

TEST(SlotMarks, LinesDoNotMeetOverBareFloor) {
  PaintedFloor floor;
  floor.line({1.5, -3.0}, {0.5, -3.0}, kLine);
  floor.line({2.0, -3.5}, {2.0, -5.5}, kLine);
  EXPECT_EQ(meetings(floor), 0);
}

// An L whose side has lost its end, and whose front's passes for a lane line.
TEST(SlotMarks, ASideThatPointsAtACornerMeetsIt) {
  PaintedFloor floor;
  floor.line({2.0, -3.0}, {2.4, -3.0}, kLine, SemanticClass::kLaneLine);
  floor.line({2.4, -3.0}, {4.5, -3.0}, kLine);
  floor.line({2.0, -3.5}, {2.0, -5.5}, kLine);
  bool found = false;
  for (const SlotMark& mark :
       findSlotMarks(floor.bev.image, LabelProbe(floor.labels),
                     {segment({2.3, -3.0}, {4.5, -3.0}), segment({2.0, -3.5}, {2.0, -5.5})})) {
    if (mark.inward.y() > -0.9 || mark.across.isZero() || mark.is_front_end) continue;
    EXPECT_LT((mark.p - Vector2d(2.0, -3.0)).norm(), 0.02);
    found = true;
  }
  EXPECT_TRUE(found);
}

// Where the side at its end is hidden.
TEST(SlotMarks, TheEndOfAnEntranceLineIsACorner) {
  PaintedFloor floor;
  floor.line({4.5, -3.0}, {2.0, -3.0}, kLine);
  std::vector<LineSegment> segments = {segment({4.5, -3.0}, {2.0, -3.0})};
  const auto ends = [&] {
    std::vector<SlotMark> marks =
        findSlotMarks(floor.bev.image, LabelProbe(floor.labels), segments);
    std::erase_if(marks, [](const SlotMark& mark) { return !mark.is_front_end; });
    return marks;
  };
  EXPECT_TRUE(ends().empty());  // any line's
  floor.line({4.5, -3.0}, {4.5, -4.0}, kLine);
  segments.push_back(segment({4.5, -3.0}, {4.5, -4.0}));
  EXPECT_TRUE(ends().empty());  // where no side is
  floor.polygon({{1.0, -6.0}, {3.0, -6.0}, {3.0, -3.2}, {1.0, -3.2}}, SemanticClass::kVehicle, 30);
  const std::vector<SlotMark> found = ends();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT((found[0].p - Vector2d(2.0, -3.0)).norm(), 0.04);
  EXPECT_LT((found[0].inward - Vector2d(0.0, -1.0)).norm(), 1e-6);
}

// The bar of a T at (2, -3), and what is measured of its line.
std::vector<SlotMark> marksOfT(double line_from) {
  PaintedFloor floor;
  floor.line({1.65, -3.0}, {2.35, -3.0}, kLine);
  std::vector<LineSegment> segments = {segment({1.65, -3.0}, {2.35, -3.0})};
  if (line_from > 0.0) {
    floor.line({2.0, -3.0 - line_from}, {2.0, -5.5}, kLine);
    segments.push_back(segment({2.0, -3.0 - line_from}, {2.0, -5.5}));
  }
  return findSlotMarks(floor.bev.image, LabelProbe(floor.labels), segments);
}

TEST(SlotMarks, ALineThatPointsAtABarsMiddleMeetsIt) {
  bool found = false;
  for (const SlotMark& mark : marksOfT(0.6)) {
    if (mark.inward.y() > -0.9) continue;
    EXPECT_LT((mark.p - Vector2d(2.0, -3.0)).norm(), 0.02);
    EXPECT_FALSE(mark.is_bar);
    found = true;
  }
  EXPECT_TRUE(found);
}

// Worn ends of lines are floor by their labels, but the network holds them for paint nearly as
// much.
double openEndOf(double doubt) {
  PaintedFloor floor;
  floor.line({2.0, -3.5}, {2.0, -5.5}, kLine);
  floor.labels.slot_line = cv::Mat(floor.labels.labels.size(), CV_8UC1, cv::Scalar(0));
  const BevGeometry& g = floor.labels.geometry;
  for (double y = -3.5; y < -3.0; y += 0.5 * g.metres_per_px) {
    const Vector2d p = g.toPixel(Vector2d(2.0, y));
    floor.labels.slot_line.at<std::uint8_t>(static_cast<int>(std::floor(p.y() + 0.5)),
                                            static_cast<int>(std::floor(p.x() + 0.5))) =
        static_cast<std::uint8_t>(255.0 - doubt * kEvidencePerLogOdds);
  }
  double y = -10.0;
  for (const SlotMark& mark : findSlotMarks(floor.bev.image, LabelProbe(floor.labels),
                                            {segment({2.0, -3.5}, {2.0, -5.5})})) {
    if (mark.inward.y() < 0.0) y = std::max(y, mark.p.y());
  }
  return y;
}

TEST(SlotMarks, WornEndsOfLinesAreFollowed) {
  EXPECT_NEAR(openEndOf(1.0), -3.06, 0.06);
  EXPECT_NEAR(openEndOf(4.0), -3.56, 0.08);
}

// What somebody who stands before a line's end hides.
TEST(SlotMarks, ALegHidesNoEndOfALine) {
  for (const double hidden : {0.3, 0.8}) {
    PaintedFloor floor;
    floor.line({2.0, -3.0}, {2.0, -5.5}, kLine);
    floor.polygon({{1.0, -2.93}, {3.0, -2.93}, {3.0, -2.93 + hidden}, {1.0, -2.93 + hidden}},
                  SemanticClass::kPedestrian, 30);
    const std::vector<SlotMark> marks = findSlotMarks(floor.bev.image, LabelProbe(floor.labels),
                                                      {segment({2.0, -3.0}, {2.0, -5.5})});
    const bool found = std::any_of(marks.begin(), marks.end(), [](const SlotMark& mark) {
      return (mark.p - Vector2d(2.0, -3.0)).norm() < 0.06;
    });
    EXPECT_EQ(found, hidden < 0.5) << hidden;
  }
}

TEST(SlotMarks, ABarByItselfMayHaveALineOnEitherHand) {
  int bars = 0;
  for (const SlotMark& mark : marksOfT(0.0)) {
    if (!mark.is_bar) continue;
    EXPECT_LT((mark.p - Vector2d(2.0, -3.0)).norm(), 0.02);
    EXPECT_NEAR(std::abs(mark.inward.y()), 1.0, 1e-6);
    ++bars;
  }
  EXPECT_EQ(bars, 2);
}

}  // namespace
}  // namespace parkade
