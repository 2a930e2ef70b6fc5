// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_rows.hpp"

#include <vector>

#include "parkade/semantics/slots/slot_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kSlotLineLabel = static_cast<double>(SemanticClass::kSlotLine);

// A row whose first slot is painted freshly. Of all its paint the network sees some: as much as
// log_odds below what it takes for a label.
PaintedFloor wornRow(const Row& row, const PaintedFloor& worn, double log_odds) {
  PaintedFloor floor;
  Row first = row;
  first.count = 1;
  first.paint(floor);
  cv::Mat& evidence = floor.labels.slot_line;
  evidence = cv::Mat(floor.labels.labels.size(), CV_8UC1, cv::Scalar(0.0));
  evidence.setTo(255.0 - kEvidencePerLogOdds * log_odds, worn.labels.labels == kSlotLineLabel);
  evidence.setTo(255.0, floor.labels.labels == kSlotLineLabel);
  return floor;
}

Row threeSlots(SlotMarking marking) {
  Row row;
  row.count = 3;
  row.marking = marking;
  return row;
}

TEST(SlotRows, FollowsLinesThatAreTooWornForLabels) {
  for (const SlotMarking marking : {SlotMarking::kT, SlotMarking::kOpen}) {
    SCOPED_TRACE(static_cast<int>(marking));
    const Row row = threeSlots(marking);
    PaintedFloor paint;
    row.paint(paint);
    PaintedFloor floor = wornRow(row, paint, 5.0);
    const std::vector<SlotObservation> slots = slotsOf(floor);
    expectRow(row, slots, SlotShape::kPerpendicular, 0.06);
    floor.labels.slot_line.release();
    EXPECT_EQ(slotsOf(floor).size(), 1U);
  }
}

TEST(SlotRows, GoesOnBehindAPillar) {
  const Row row = threeSlots(SlotMarking::kOpen);
  Row behind = row;
  behind.count = 1;
  behind.x0 = row.front(1).x() - 0.8;
  PaintedFloor paint;
  behind.paint(paint);
  const PaintedFloor floor = wornRow(row, paint, 5.0);
  const std::vector<SlotObservation> slots = slotsOf(floor);
  ASSERT_EQ(slots.size(), 2U);
  const SlotObservation* slot = slotAt(slots, behind.front(0));
  ASSERT_NE(slot, nullptr);
  EXPECT_LT((slot->corners[1] - behind.front(1)).norm(), 0.06);
}

TEST(SlotRows, TellsNoneWithoutALineOfTheRowsWidth) {
  const Row row = threeSlots(SlotMarking::kOpen);
  // Nothing at all, as evenly as it may be.
  PaintedFloor floor = wornRow(row, PaintedFloor(), 5.0);
  floor.labels.slot_line.setTo(180.0, floor.labels.labels != kSlotLineLabel);
  EXPECT_EQ(slotsOf(floor).size(), 1U);
  // A line at another distance.
  PaintedFloor other;
  other.line(row.front(2) + Vector2d(0.4, 0.0), row.rear(2) + Vector2d(0.4, 0.0), kLine);
  EXPECT_EQ(slotsOf(wornRow(row, other, 5.0)).size(), 1U);
  // One that crosses the aisle: no entrance begins there.
  PaintedFloor across;
  across.line({row.front(2).x(), 2.0}, row.rear(2), kLine);
  EXPECT_EQ(slotsOf(wornRow(row, across, 5.0)).size(), 1U);
}

// One side of a slot is painted freshly, the other too worn for a label, and no other slot is
// there.
TEST(SlotRows, AWornSideByItselfWillDoWhereTheEntranceShows) {
  for (const SlotMarking marking : {SlotMarking::kT, SlotMarking::kOpen}) {
    Row row;
    row.count = 1;
    row.marking = marking;
    PaintedFloor paint;
    row.paint(paint);
    PaintedFloor floor;
    floor.line(row.front(0), row.rear(0), kLine);
    const Vector2d bar(0.3, 0.0);
    if (marking == SlotMarking::kT) floor.line(row.front(0) - bar, row.front(0) + bar, kLine);
    cv::Mat& evidence = floor.labels.slot_line;
    evidence = cv::Mat(floor.labels.labels.size(), CV_8UC1, cv::Scalar(0.0));
    evidence.setTo(255.0 - kEvidencePerLogOdds * 4.0, paint.labels.labels == kSlotLineLabel);
    evidence.setTo(255.0, floor.labels.labels == kSlotLineLabel);
    const std::vector<SlotObservation> slots = slotsOf(floor);
    ASSERT_EQ(slots.size(), marking == SlotMarking::kT ? 1U : 0U);
    if (slots.empty()) continue;
    EXPECT_LT((slots[0].corners[0] - row.front(0)).norm(), 0.05);
    EXPECT_LT((slots[0].corners[1] - row.front(1)).norm(), 0.08);
  }
}

TEST(SlotRows, ACarOverALineHidesIt) {
  const Row row = threeSlots(SlotMarking::kOpen);
  PaintedFloor paint;
  row.paint(paint);
  PaintedFloor floor = wornRow(row, paint, 5.0);
  const double x = row.front(2).x();
  floor.polygon({{x - 2.2, -8.0}, {x + 0.5, -8.0}, {x + 0.5, -2.7}, {x - 2.2, -2.7}},
                SemanticClass::kVehicle, 30);
  EXPECT_EQ(slotsOf(floor).size(), 1U);
}

}  // namespace
}  // namespace parkade
