// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/agent_slots.hpp"

#include <gtest/gtest.h>

namespace parkade {
namespace {

using Eigen::Vector2d;

// A slot on the left, its entrance along x from x0 on (seen by who drives in), 2.5 m wide.
SlotObservation slotAt(double x0) {
  SlotObservation slot;
  slot.corners = {Vector2d(x0, 3.0), Vector2d(x0 + 2.5, 3.0), Vector2d(x0 + 2.5, 8.0),
                  Vector2d(x0, 8.0)};
  return slot;
}

// Points every 5 cm along a line.
void addFace(const Vector2d& from, const Vector2d& to, std::vector<Vector2d>& points) {
  const int count = static_cast<int>((to - from).norm() / 0.05);
  for (int i = 0; i < count; ++i) points.push_back(from + i * (to - from) / count);
}

TEST(AgentSlots, FrontsInTwoSlotsPart) {
  std::vector<Vector2d> swept;
  addFace({0.3, 3.4}, {2.2, 3.4}, swept);
  const std::size_t first = swept.size();
  addFace({2.8, 3.6}, {4.7, 3.6}, swept);
  const std::size_t at = findSlotChange(swept, {slotAt(0.0), slotAt(2.5)});
  EXPECT_EQ(at, first);
  EXPECT_EQ(findSlotChange(swept, {slotAt(0.0)}), 0U);  // nothing known of the other
  EXPECT_EQ(findSlotChange(swept, {}), 0U);
}

TEST(AgentSlots, OneCarsFrontAndFlankStayTogether) {
  std::vector<Vector2d> swept;
  addFace({0.3, 3.4}, {2.2, 3.4}, swept);
  addFace({2.4, 3.6}, {2.8, 6.5}, swept);  // seems to lie beyond its slot
  EXPECT_EQ(findSlotChange(swept, {slotAt(0.0), slotAt(2.5)}), 0U);
}

TEST(AgentSlots, ACarThatPassesInFrontIsOne) {
  std::vector<Vector2d> swept;
  addFace({-1.0, 2.0}, {3.5, 2.0}, swept);
  EXPECT_EQ(findSlotChange(swept, {slotAt(0.0), slotAt(2.5)}), 0U);
}

TEST(AgentSlots, RowsGoOnBeyondTheSlotsThatAreTold) {
  std::vector<Vector2d> front;
  addFace({5.5, 3.4}, {7.4, 3.4}, front);  // of a car one slot further
  const std::optional<double> heading = findRowHeading(front, {slotAt(0.0)});
  ASSERT_TRUE(heading.has_value());
  EXPECT_NEAR(*heading, M_PI_2, 1e-9);
  EXPECT_FALSE(findRowHeading(front, {}).has_value());
  for (Vector2d& p : front) p.x() += 10.0;  // another row
  EXPECT_FALSE(findRowHeading(front, {slotAt(0.0)}).has_value());
  std::vector<Vector2d> flank;
  addFace({-1.0, 1.5}, {3.5, 1.5}, flank);  // on the aisle
  EXPECT_FALSE(findRowHeading(flank, {slotAt(0.0)}).has_value());
  SlotObservation along = slotAt(0.0);
  along.shape = SlotShape::kParallel;
  std::vector<Vector2d> parked;
  addFace({0.3, 3.4}, {2.2, 3.4}, parked);
  EXPECT_FALSE(findRowHeading(parked, {along}).has_value());
}

}  // namespace
}  // namespace parkade
