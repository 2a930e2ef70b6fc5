// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_clues.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "parkade/semantics/slots/slot_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

double clue(const SlotClues& clues, std::string_view name) {
  const auto it = std::find(kSlotClueNames.begin(), kSlotClueNames.end(), name);
  EXPECT_NE(it, kSlotClueNames.end()) << name;
  return clues[static_cast<std::size_t>(it - kSlotClueNames.begin())];
}

// Of the pair of marks at the corners of the row's i-th slot.
SlotClues cluesOf(const PaintedFloor& floor, const Row& row, int i = 0) {
  const Lines lines = extractLines(floor.bev, floor.labels, 0.0);
  std::vector<SlotTrial> trials;
  extractSlots(floor.bev, floor.labels, lines.segments, BevViews::fromMiddle(floor.labels.geometry),
               {}, {}, &trials);
  for (const SlotTrial& trial : trials) {
    if ((trial.left - row.front(i)).norm() < 0.1 && (trial.right - row.front(i + 1)).norm() < 0.1) {
      return trial.clues;
    }
  }
  ADD_FAILURE() << "no such pair";
  return {};
}

TEST(SlotClues, OfAPlainRow) {
  Row row;
  PaintedFloor floor;
  row.paint(floor);
  const SlotClues clues = cluesOf(floor, row);
  EXPECT_EQ(clue(clues, "seen"), 1.0);
  EXPECT_EQ(clue(clues, "closed"), 1.0);
  EXPECT_GT(clue(clues, "way_floor"), 0.9);
  EXPECT_GT(clue(clues, "neighbours"), 0.4);
  EXPECT_LT(clue(clues, "skew"), 0.05);
  for (const char* name :
       {"way_paint", "paint_across", "away", "lane_beyond", "stop_in_front", "slanted", "parallel",
        "pillar", "faint", "turned_out", "bars", "ends_short"}) {
    EXPECT_EQ(clue(clues, name), 0.0) << name;
  }
  EXPECT_GT(slotLogOdds(clues), 2.0);
}

TEST(SlotClues, WheelStopsAtTheEntrance) {
  Row row;
  PaintedFloor floor;
  row.paint(floor);
  const double before = slotLogOdds(cluesOf(floor, row));
  const Vector2d middle = 0.5 * (row.front(0) + row.front(1));
  PaintedFloor stop = floor;
  stop.line(middle + Vector2d(0.9, -0.6), middle + Vector2d(-0.9, -0.6), 0.2,
            SemanticClass::kWheelStop, 150);
  EXPECT_GT(clue(cluesOf(stop, row), "stop_in_front"), 0.5);
  EXPECT_LT(slotLogOdds(cluesOf(stop, row)), before - 3.0);
}

// A pillar as the camera in the picture's middle sees it: smeared away from it, with ragged edges.
void addPillar(PaintedFloor& floor, const Vector2d& at) {
  const Vector2d ray = at - floor.labels.geometry.center;
  const Vector2d aside = Vector2d(-ray.y(), ray.x()).normalized();
  for (int k = 0; k < 8; ++k) {
    const Vector2d from = at + 0.1 * k * ray;
    const Vector2d half = (0.25 + 0.09 * k) * aside;
    floor.polygon({from - half, at + ray - half, at + ray + half, from + half},
                  SemanticClass::kPillar, 60);
  }
}

TEST(SlotClues, APillarThatStandsBesideIsNotInTheWay) {
  Row row;
  row.x0 = 7.0;
  row.count = 1;
  PaintedFloor inside;
  row.paint(inside);
  addPillar(inside, {5.6, -3.2});
  EXPECT_GT(clue(cluesOf(inside, row), "pillar"), 0.2);
  PaintedFloor beside;
  row.paint(beside);
  addPillar(beside, {4.1, -2.9});
  EXPECT_EQ(clue(cluesOf(beside, row), "pillar"), 0.0);
}

// The gap between two slots along the aisle is as wide as a slot into it, but its lines are short.
TEST(SlotClues, SidesMayEndTooEarly) {
  Row gap;
  gap.depth = 2.3;
  gap.count = 1;
  gap.marking = SlotMarking::kOpen;
  PaintedFloor floor;
  gap.paint(floor);
  EXPECT_TRUE(slotsOf(floor).empty());
  // Too worn for labels, but held for lines: they go on.
  PaintedFloor whole;
  Row slot = gap;
  slot.depth = 5.0;
  slot.paint(whole);
  PaintedFloor worn = floor;
  worn.labels.slot_line = cv::Mat(floor.labels.labels.size(), CV_8UC1, cv::Scalar(0.0));
  worn.labels.slot_line.setTo(255.0 - 3.0 * kEvidencePerLogOdds,
                              whole.labels.labels == static_cast<int>(SemanticClass::kSlotLine));
  EXPECT_EQ(slotsOf(worn).size(), 1U);
  const double x = gap.front(1).x();
  PaintedFloor hidden = floor;  // a pillar before the end of one of them
  hidden.polygon({{x + 0.4, -9.0}, {x + 0.4, -3.4}, {x - 0.4, -3.4}, {x - 0.4, -9.0}},
                 SemanticClass::kPillar, 60);
  EXPECT_EQ(clue(cluesOf(hidden, gap), "ends_short"), 0.5);
  PaintedFloor apart;  // one has worn off before the other
  apart.line(gap.front(0), gap.rear(0), kLine);
  apart.line(gap.front(1), gap.front(1) - Vector2d(0.0, 1.2), kLine);
  EXPECT_EQ(clue(cluesOf(apart, gap), "ends_short"), 1.0);
}

TEST(SlotClues, SlotsAlongTheAisleAreParallel) {
  Row row;
  row.width = 6.0;
  row.depth = 2.3;
  row.count = 1;
  PaintedFloor floor;
  row.paint(floor);
  const SlotClues clues = cluesOf(floor, row);
  EXPECT_EQ(clue(clues, "parallel"), 1.0);
  EXPECT_EQ(clue(clues, "unusual_width"), 0.0);
}

}  // namespace
}  // namespace parkade
