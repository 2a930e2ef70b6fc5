// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// Of the slot registry: what it tells, and what it takes for missed. Whole drives are in
// registry_test.cpp.
#include "parkade/mapping/slots/slot_registry.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "parkade/mapping/slots/row_test_support.hpp"

namespace parkade {
namespace {

using testing::Garage;

constexpr TimeNs kTick = 100'000'000;

// As seen from a vehicle that is not turned.
SlotObservation observed(const MapSlot& slot, const Eigen::Vector2d& from = {0.0, 0.0}) {
  SlotObservation o;
  for (std::size_t k = 0; k < 4; ++k) o.corners[k] = slot.corners[k] - from;
  o.entrance_covariance = 1e-3 * Eigen::Matrix4d::Identity();
  o.rear_seen = true;
  o.confidence = 0.9;
  return o;
}

MapSlot slotAhead() {
  MapSlot slot;
  slot.corners = {Eigen::Vector2d(2, 2), Eigen::Vector2d(4.5, 2), Eigen::Vector2d(4.5, 7),
                  Eigen::Vector2d(2, 7)};
  return slot;
}

// A floor with a square of another class.
BevLabels floorWith(SemanticClass c, const Eigen::Vector2d& at) {
  BevLabels labels;
  labels.labels = cv::Mat(labels.geometry.height_px, labels.geometry.width_px, CV_8UC1,
                          cv::Scalar(static_cast<int>(SemanticClass::kFloor)));
  for (int v = 0; v < labels.labels.rows; ++v) {
    for (int u = 0; u < labels.labels.cols; ++u) {
      const Eigen::Vector2d d = labels.geometry.toGround({u, v}) - at;
      if (d.cwiseAbs().maxCoeff() > 0.3) continue;
      labels.labels.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(c);
    }
  }
  return labels;
}

TEST(SlotRegistry, ASlotIsMissedWhereTheGroundAtItsEntranceIsSeen) {
  const auto told = [](const BevLabels& labels) {
    SlotRegistry registry({});
    for (int k = 0; k < 5; ++k) registry.update({observed(slotAhead())}, k * kTick, SE2(), 0);
    for (int k = 5; k < 200; ++k) registry.update({}, k * kTick, SE2(), 0, true, &labels);
    return registry.slots(200 * kTick).size();
  };
  const Eigen::Vector2d left(2.0, 2.0);
  const Eigen::Vector2d middle(3.25, 2.0);
  const Eigen::Vector2d right(4.5, 2.0);
  EXPECT_EQ(told(floorWith(SemanticClass::kFloor, left)), 0U);
  EXPECT_EQ(told(floorWith(SemanticClass::kLaneLine, left)), 0U);
  EXPECT_EQ(told(floorWith(SemanticClass::kVehicle, left)), 1U);
  EXPECT_EQ(told(floorWith(SemanticClass::kUnknown, middle)), 1U);
  EXPECT_EQ(told(floorWith(SemanticClass::kWall, right)), 1U);
  BevLabels elsewhere = floorWith(SemanticClass::kFloor, left);
  elsewhere.geometry.center = {-4.0, 0.0};
  EXPECT_EQ(told(elsewhere), 1U);
}

TEST(SlotRegistry, ManyLooksKnowCornersNoBetterThanWhatTheyShare) {
  SlotRegistry registry({});
  for (int k = 0; k < 50; ++k) registry.update({observed(slotAhead())}, k * kTick, SE2(), 0);
  const std::vector<MapSlot> slots = registry.slots(50 * kTick);
  ASSERT_EQ(slots.size(), 1U);
  const double floor = SlotRegistryOptions().corner_floor_m;
  EXPECT_GE(slots[0].corner_sigma, floor);
  EXPECT_LT(slots[0].corner_sigma, 1.1 * floor);
}

// A line at the entrance that is worn away beyond a place passes for a corner there, though not a
// sharp one, from farther off and so in more looks.
TEST(SlotRegistry, OfTwoReadingsOfAPlaceTheSharperOneIsTold) {
  MapSlot narrow = slotAhead();
  narrow.corners[1].x() -= 1.0;
  narrow.corners[2].x() -= 1.0;
  const auto widthTold = [&](double sigma_of_narrow) {
    SlotRegistry registry({});
    for (int k = 0; k < 23; ++k) {
      SlotObservation o = observed(k < 15 ? narrow : slotAhead());
      const double sigma = k < 15 ? sigma_of_narrow : 0.02;
      o.entrance_covariance.bottomRightCorner<2, 2>() = sigma * sigma * Eigen::Matrix2d::Identity();
      registry.update({o}, k * kTick, SE2(), 0);
    }
    const std::vector<MapSlot> slots = registry.slots(23 * kTick);
    return slots.size() == 1U ? (slots[0].corners[1] - slots[0].corners[0]).norm() : 0.0;
  };
  EXPECT_NEAR(widthTold(0.08), 2.5, 0.05);
  EXPECT_NEAR(widthTold(0.02), 1.5, 0.05);
}

TEST(SlotRegistry, SlotsToldByTheirRowFadeAsOthersDo) {
  Garage garage;
  garage.tell(0, {0, 2});
  garage.paintTold();
  const Eigen::Vector2d from(4.0, -3.0);
  SlotRegistry registry({});
  TimeNs t_ns = 0;
  for (int k = 0; k < 20; ++k) {
    std::vector<SlotObservation> seen;
    for (const MapSlot& slot : garage.told) seen.push_back(observed(slot, from));
    registry.update(seen, t_ns += kTick, SE2(0.0, from), 0);
  }
  registry.completeRows(t_ns, garage.objects, garage.grid);
  const auto freeAfter = [&](double seconds) {
    const TimeNs now_ns = t_ns + static_cast<TimeNs>(seconds * 1e9);
    const std::vector<MapSlot> slots = registry.slots(now_ns);
    const auto filling = std::find_if(slots.begin(), slots.end(),
                                      [](const MapSlot& slot) { return slot.observations == 0; });
    return filling == slots.end() ? -1.0 : filling->probability_free;
  };
  EXPECT_NEAR(freeAfter(0.0), 0.9, 1e-9);
  // Log-odds fall to 1 / e.
  EXPECT_NEAR(freeAfter(SlotRegistryOptions().change_time_s), 0.692, 0.001);
  EXPECT_NEAR(freeAfter(6000.0), 0.5, 0.001);
}

}  // namespace
}  // namespace parkade
