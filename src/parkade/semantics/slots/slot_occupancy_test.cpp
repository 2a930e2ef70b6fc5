// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_occupancy.hpp"

#include <gtest/gtest.h>

#include "parkade/semantics/features_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

// A slot on the right of the car, between x = -2.5 and 0; a car stands in the next one, before x
// = 2.5.
const std::array<Vector2d, 4> kSlot = {Vector2d(0.0, -2.6), Vector2d(-2.5, -2.6),
                                       Vector2d(-2.5, -7.6), Vector2d(0.0, -7.6)};
const Vector2d kAhead(4.0, -1.0);    // ground point under a camera
const Vector2d kBehind(-1.2, -1.0);  // and under another

// Two cameras' parts, with their seam at x = seam_x.
BevViews twoViews(double seam_x) {
  const BevGeometry geometry = PaintedFloor::geometry();
  BevViews views;
  views.views = {{kAhead, 1.0}, {kBehind, 1.0}};
  views.view_of = cv::Mat(geometry.height_px, geometry.width_px, CV_8UC1);
  for (int v = 0; v < geometry.height_px; ++v) {
    const bool ahead = geometry.toGround(Vector2d(0.0, v)).x() > seam_x;
    views.view_of.row(v).setTo(cv::Scalar(ahead ? 0 : 1));
  }
  return views;
}

double freeWith(const PaintedFloor& floor, double seam_x) {
  return probabilityFree(LabelProbe(floor.labels), twoViews(seam_x), kSlot);
}

PaintedFloor withNextCar() {
  PaintedFloor floor;
  floor.polygon({{2.2, -7.0}, {2.2, -3.4}, {0.3, -3.4}, {0.3, -7.0}}, SemanticClass::kVehicle, 30);
  return floor;
}

TEST(SlotOccupancy, FloorBesideACarIsFree) {
  EXPECT_GT(freeWith(withNextCar(), 0.5), 0.9);
}

// The next slot's car, smeared over this one by the camera ahead, in what the one behind shows.
TEST(SlotOccupancy, AGhostOfTheNextCarSaysNothing) {
  PaintedFloor floor = withNextCar();
  floor.polygon({{0.3, -7.6}, {0.3, -3.4}, {-2.4, -5.2}, {-2.4, -7.6}}, SemanticClass::kVehicle,
                60);
  EXPECT_GT(freeWith(floor, 0.2), 0.3);
  // Far from the seam it is a car: the one camera alone shows it.
  EXPECT_LT(freeWith(floor, 6.0), 0.1);
}

TEST(SlotOccupancy, SightLinesComeInOverTheEntranceOrAcrossTheNextSlot) {
  const auto share = [](double seam_x) {
    return shareSeenOverEntrance(PaintedFloor::geometry(), twoViews(seam_x), kSlot);
  };
  EXPECT_EQ(share(6.0), 1.0);   // the camera before the slot shows all of it
  EXPECT_EQ(share(-6.0), 0.0);  // the one ahead looks across the next slot
  EXPECT_NEAR(share(-1.25), 0.5, 0.1);
  // A camera on the slot's other side looks over its rear.
  BevViews behind = twoViews(6.0);
  behind.views[1].foot = Vector2d(-1.2, -12.0);
  EXPECT_EQ(shareSeenOverEntrance(PaintedFloor::geometry(), behind, kSlot), 0.0);
}

TEST(SlotOccupancy, ACarThatBothCamerasSeeIsOne) {
  PaintedFloor floor;
  floor.polygon({{-0.3, -7.4}, {-0.3, -3.2}, {-2.2, -3.2}, {-2.2, -7.4}}, SemanticClass::kVehicle,
                60);
  EXPECT_LT(freeWith(floor, 0.2), 0.1);
  EXPECT_LT(freeWith(floor, 6.0), 0.1);
}

}  // namespace
}  // namespace parkade
