// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "parkade/semantics/features_test_support.hpp"
#include "parkade/semantics/lines/line_extraction.hpp"
#include "parkade/semantics/slots/slot_extraction.hpp"

namespace parkade {

constexpr double kFront = -2.6;  // y of the row's entrances, right of the car
constexpr double kLine = 0.12;   // m

/// A row on the right of the car: count slots of a width along x from x0 backwards, as a driver
/// entering them sees the left one at the larger x.
struct Row {
  double x0 = 5.0;
  double width = 2.5;
  double depth = 5.0;
  int count = 2;
  SlotMarking marking = SlotMarking::kClosed;
  double lean = 0.0;  // m that the rear lies further back (-x)

  [[nodiscard]] Eigen::Vector2d front(int i) const { return {x0 - i * width, kFront}; }
  [[nodiscard]] Eigen::Vector2d rear(int i) const {
    return {x0 - i * width - lean, kFront - depth};
  }

  void paint(PaintedFloor& floor) const {
    for (int i = 0; i <= count; ++i) {
      floor.line(front(i), rear(i), kLine);
      constexpr double kBar = 0.3;
      const Eigen::Vector2d bar(kBar, 0.0);
      const bool first = i == 0;
      const bool last = i == count;
      if (marking == SlotMarking::kT || (marking == SlotMarking::kL && !first)) {
        floor.line(front(i), front(i) + bar, kLine);
      }
      if (marking == SlotMarking::kT || (marking == SlotMarking::kL && !last)) {
        floor.line(front(i) - bar, front(i), kLine);
      }
    }
    if (marking != SlotMarking::kClosed) return;
    floor.line(front(0), front(count), kLine);
    floor.line(rear(0), rear(count), kLine);
  }
};

inline std::vector<SlotObservation> slotsOf(const PaintedFloor& floor,
                                            const FloorSigma& sigma = {}) {
  const Lines lines = extractLines(floor.bev, floor.labels, sigma.attitude);
  return extractSlots(floor.bev, floor.labels, lines.segments,
                      BevViews::fromMiddle(floor.labels.geometry), sigma);
}

inline const SlotObservation* slotAt(const std::vector<SlotObservation>& slots,
                                     const Eigen::Vector2d& left) {
  const auto it = std::find_if(slots.begin(), slots.end(), [&](const SlotObservation& slot) {
    return (slot.corners[0] - left).norm() < 0.5;
  });
  return it == slots.end() ? nullptr : &*it;
}

inline void expectRow(const Row& row, const std::vector<SlotObservation>& slots, SlotShape shape,
                      double tolerance) {
  ASSERT_EQ(slots.size(), static_cast<std::size_t>(row.count));
  for (int i = 0; i < row.count; ++i) {
    const SlotObservation* slot = slotAt(slots, row.front(i));
    ASSERT_NE(slot, nullptr) << i;
    EXPECT_LT((slot->corners[0] - row.front(i)).norm(), tolerance) << i;
    EXPECT_LT((slot->corners[1] - row.front(i + 1)).norm(), tolerance) << i;
    EXPECT_EQ(slot->shape, shape) << i;
    EXPECT_GT(slot->confidence, 0.8) << i;
    const Eigen::Vector2d side = slot->corners[3] - slot->corners[0];
    const Eigen::Vector2d wanted = row.rear(i) - row.front(i);
    EXPECT_GT(side.normalized().dot(wanted.normalized()), 0.999) << i;
  }
}

}  // namespace parkade
