// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// What a standing car sees again and again tells of what comes and goes alone.
#include <gtest/gtest.h>

#include <utility>

#include "parkade/mapping/global_map.hpp"
#include "parkade/mapping/local_map.hpp"
#include "parkade/mapping/objects/object_registry.hpp"
#include "parkade/mapping/slots/slot_registry.hpp"

namespace parkade {
namespace {

constexpr TimeNs kTick = 500'000'000;
constexpr int kMinute = 120;  // looks

SlotObservation slotBeside(double from, double to) {
  SlotObservation o;
  o.corners = {Eigen::Vector2d(from, 2), Eigen::Vector2d(to, 2), Eigen::Vector2d(to, 7),
               Eigen::Vector2d(from, 7)};
  o.entrance_covariance = 1e-3 * Eigen::Matrix4d::Identity();
  o.confidence = 0.9;
  return o;
}

TEST(StandingCar, LearnsOfSlotsOnlyWhetherTheyAreFree) {
  constexpr int kLooks = 5;
  SlotRegistry registry({});
  for (int k = 0; k < kLooks; ++k) {
    registry.update({slotBeside(2.0, 4.5)}, k * kTick, SE2(), 0);
  }
  const std::vector<MapSlot> before = registry.slots(kLooks * kTick);
  ASSERT_EQ(before.size(), 1U);
  SlotObservation misread = slotBeside(2.0, 4.6);
  misread.probability_free = 0.02;
  misread.number = {{"17", 0.95}};
  misread.number_place = {3.2, 4.5};
  for (int k = kLooks; k < kMinute; ++k) {
    registry.update({misread, slotBeside(9.0, 11.5)}, k * kTick, SE2(), 0, false);
  }
  const std::vector<MapSlot> after = registry.slots(kMinute * kTick);
  EXPECT_EQ(registry.candidates(), 1);
  ASSERT_EQ(after.size(), 1U);
  EXPECT_TRUE(after[0].corners == before[0].corners);
  EXPECT_EQ(after[0].corner_sigma, before[0].corner_sigma);
  EXPECT_EQ(after[0].observations, kLooks);
  EXPECT_EQ(after[0].number, "");
  EXPECT_EQ(after[0].last_seen_ns, (kMinute - 1) * kTick);
  EXPECT_LT(after[0].probability_free, 0.1);
}

TEST(StandingCar, LearnsOfZoneMarkersAndSignsAloneWhichAreFollowed) {
  ObjectObservation arrow;
  arrow.semantic_class = SemanticClass::kArrow;
  arrow.position = {4.0, 0.0, 0.0};
  arrow.covariance = 4e-4 * Eigen::Matrix3d::Identity();
  arrow.text = "straight";
  arrow.confidence = 0.9;
  ObjectRegistry registry({});
  for (int k = 0; k < 3; ++k) registry.update({arrow}, SE2(), 0.0, 0);
  ObjectObservation stop = arrow;
  stop.semantic_class = SemanticClass::kWheelStop;
  ObjectObservation misread = arrow;
  misread.position.x() = 4.1;
  misread.text = "left";
  for (int k = 3; k < kMinute; ++k) {
    registry.update({misread, stop}, SE2(), 0.0, 0, nullptr, {}, false);
  }
  ObjectObservation marker = arrow;
  marker.semantic_class = SemanticClass::kZoneMarker;
  marker.position = {20.0, 3.0, 1.6};
  marker.text = "B1";
  registry.update({marker}, SE2(), 0.0, 0, nullptr, {}, false);
  const std::vector<MapObject> objects = registry.objects();
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].position.x(), 4.0);
  EXPECT_EQ(objects[0].text, "straight");
  EXPECT_EQ(objects[0].observations, 3);
  EXPECT_EQ(objects[1].text, "B1");
}

PackedLabels pictureOf(SemanticClass c) {
  SemanticFrame frame;
  const BevGeometry& g = frame.labels.geometry;
  frame.labels.labels = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(static_cast<int>(c)));
  return packLabels(frame);
}

TEST(StandingCar, RubsNoPaintOut) {
  const Eigen::Vector2i cell(40, 0);
  const PackedLabels floor = pictureOf(SemanticClass::kFloor);
  for (const auto& [c, layer] : {std::pair(SemanticClass::kSlotLine, GridLayer::kParkingLines),
                                 {SemanticClass::kArrow, GridLayer::kRoadMarkers},
                                 {SemanticClass::kPillar, GridLayer::kZoneMarkers}}) {
    LocalMap local({});
    GlobalMap global({});
    global.setAnchor(0, SE2());
    local.update(pictureOf(c), 0, SE2());
    global.update(pictureOf(c), 0, 0, SE2());
    TimeNs t_ns = 0;
    for (int k = 1; k <= kMinute; ++k) {
      t_ns += kTick;
      local.update(floor, t_ns, SE2(), false);
      global.update(floor, t_ns, 0, SE2(), false);
    }
    EXPECT_EQ(local.at(layer, cell).believed(), c);
    EXPECT_EQ(local.at(GridLayer::kAvailability, cell).believed(), SemanticClass::kFloor);
    EXPECT_EQ(global.grid().at(layer, cell).believed(), c);
    global.finish();  // enters all pictures anew
    EXPECT_EQ(global.grid().at(layer, cell).believed(), c);
    EXPECT_EQ(global.grid().at(GridLayer::kAvailability, cell).believed(), SemanticClass::kFloor);
    // It moves, however slowly.
    for (int k = 1; k <= 20; ++k) {
      global.update(floor, t_ns += kTick, 0, SE2(0.0, {k % 2 == 0 ? 0.0 : 0.3, 0.0}), false);
    }
    EXPECT_EQ(global.grid().at(layer, cell).believed(), SemanticClass::kFloor);
  }
}

}  // namespace
}  // namespace parkade
