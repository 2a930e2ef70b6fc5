// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/smear_finder.hpp"

#include <gtest/gtest.h>

#include "parkade/semantics/features_test_support.hpp"
#include "parkade/semantics/label_probe.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A pillar's smear: a wedge from x = 4 outwards, as a camera in the picture's middle draws it.
PaintedFloor smearedPillar() {
  PaintedFloor floor;
  floor.polygon({{4.0, -0.3}, {8.8, -0.9}, {8.8, 0.9}, {4.0, 0.3}}, SemanticClass::kPillar, 60);
  return floor;
}

SmearFinder finderOf(const PaintedFloor& floor, const SmearOptions& options = {}) {
  const BevGeometry& g = floor.labels.geometry;
  return {g, BevViews::fromMiddle(g), options};
}

TEST(SmearFinder, KeepsTheNearEdgeOnly) {
  PaintedFloor floor = smearedPillar();
  floor.labels.labels.setTo(0, finderOf(floor).find(floor.labels) == SemanticFrame::kSmear);
  const LabelProbe probe(floor.labels);
  EXPECT_EQ(probe.at({4.1, 0.0}), SemanticClass::kPillar);
  EXPECT_EQ(probe.at({4.4, 0.2}), SemanticClass::kPillar);
  for (const double x : {4.8, 6.0, 8.5}) {
    for (const double y : {-0.2, 0.0, 0.2}) {
      EXPECT_EQ(probe.at({x, y}), SemanticClass::kUnknown) << x << ", " << y;
    }
  }
  EXPECT_EQ(probe.at({5.0, 2.0}), SemanticClass::kFloor);
}

TEST(SmearFinder, OnlyTheEdgeIsSure) {
  const PaintedFloor floor = smearedPillar();
  const cv::Mat smear = finderOf(floor).find(floor.labels);
  const auto at = [&](double x) {
    const Vector2d q = floor.labels.geometry.toPixel({x, 0.0});
    return int{smear.at<std::uint8_t>(static_cast<int>(q.y()), static_cast<int>(q.x()))};
  };
  EXPECT_EQ(at(3.8), 0);
  EXPECT_EQ(at(4.07), 0);
  EXPECT_EQ(at(4.3), SemanticFrame::kBehindEdge);
  EXPECT_EQ(at(5.0), SemanticFrame::kSmear);
}

TEST(SmearFinder, FloorIsSeenAgainBehindAWheelStop) {
  PaintedFloor floor;
  for (const double x : {4.0, 6.0}) {
    floor.polygon({{x, -0.8}, {x + 0.6, -0.9}, {x + 0.6, 0.9}, {x, 0.8}}, SemanticClass::kWheelStop,
                  200);
  }
  const cv::Mat smear = finderOf(floor).find(floor.labels);
  for (const double x : {4.0, 6.0}) {
    const auto at = [&](double behind) {
      const Vector2d q = floor.labels.geometry.toPixel({x + behind, 0.3});
      return int{smear.at<std::uint8_t>(static_cast<int>(q.y()), static_cast<int>(q.x()))};
    };
    EXPECT_EQ(at(0.1), 0) << x;
    EXPECT_EQ(at(0.3), SemanticFrame::kSmear) << x;
    EXPECT_EQ(at(0.5), SemanticFrame::kSmear) << x;
  }
}

TEST(SmearFinder, HolesInASmearAreNoNewEdges) {
  PaintedFloor floor = smearedPillar();
  floor.polygon({{5.5, -0.9}, {6.5, -0.9}, {6.5, 0.9}, {5.5, 0.9}}, SemanticClass::kFloor, 90);
  floor.labels.labels.setTo(0, finderOf(floor).find(floor.labels) == SemanticFrame::kSmear);
  const LabelProbe probe(floor.labels);
  EXPECT_EQ(probe.at({6.6, 0.0}), SemanticClass::kUnknown);
  EXPECT_EQ(probe.at({6.0, 0.0}), SemanticClass::kFloor);  // only structure is doubted
}

// Two cameras whose parts meet amid the smear, the farther one's pixels being nearer to it.
TEST(SmearFinder, GoesOnAcrossSeams) {
  PaintedFloor floor = smearedPillar();
  const BevGeometry& g = floor.labels.geometry;
  BevViews views = BevViews::fromMiddle(g);
  views.views.push_back({{3.0, -3.0}, 1.0});
  const int seam = static_cast<int>(g.toPixel({6.5, 0.0}).y());
  views.view_of.rowRange(0, seam).setTo(1);
  const cv::Mat smear = SmearFinder(g, views, {}).find(floor.labels);
  floor.labels.labels.setTo(0, smear == SemanticFrame::kSmear);
  const LabelProbe probe(floor.labels);
  for (double y = -0.15; y < 0.2; y += 0.04) {
    EXPECT_EQ(probe.at({6.55, y}), SemanticClass::kUnknown) << y;
  }
}

TEST(SmearFinder, WhatACarHidesHasNoPlace) {
  PaintedFloor floor = smearedPillar();
  floor.polygon({{3.0, -1.0}, {4.0, -1.0}, {4.0, 0.0}, {3.0, 0.0}}, SemanticClass::kVehicle, 40);
  floor.labels.labels.setTo(0, finderOf(floor).find(floor.labels) == SemanticFrame::kSmear);
  const LabelProbe probe(floor.labels);
  EXPECT_EQ(probe.at({4.2, -0.15}), SemanticClass::kUnknown);
  EXPECT_EQ(probe.at({4.2, 0.15}), SemanticClass::kPillar);
  EXPECT_EQ(probe.at({3.5, -0.5}), SemanticClass::kVehicle);
}

// A bare wall's smear passes for floor.
TEST(SmearFinder, NothingIsSeenBehindAWall) {
  PaintedFloor floor;
  floor.polygon({{4.0, -1.0}, {4.5, -1.0}, {4.5, 1.0}, {4.0, 1.0}}, SemanticClass::kWall, 60);
  floor.polygon({{4.0, 2.0}, {4.15, 2.0}, {4.15, 4.0}, {4.0, 4.0}}, SemanticClass::kWall, 60);
  floor.polygon({{6.0, -0.4}, {6.0, 0.4}, {6.2, 0.4}, {6.2, -0.4}}, SemanticClass::kSlotLine, 220);
  floor.labels.labels.setTo(0, finderOf(floor).find(floor.labels) == SemanticFrame::kSmear);
  const LabelProbe probe(floor.labels);
  EXPECT_EQ(probe.at({4.2, 0.0}), SemanticClass::kWall);
  for (const double x : {4.6, 6.1, 8.0}) {
    EXPECT_EQ(probe.at({x, 0.0}), SemanticClass::kUnknown) << x;
  }
  EXPECT_EQ(probe.at({3.8, 0.0}), SemanticClass::kFloor);
  EXPECT_EQ(probe.at({5.0, 3.0}), SemanticClass::kFloor) << "a stripe is no wall";
}

TEST(SmearFinder, WallsAreThinAndSpecksBlockNothing) {
  PaintedFloor floor;
  floor.polygon({{4.0, -3.0}, {9.0, -3.0}, {9.0, 3.0}, {4.0, 3.0}}, SemanticClass::kWall, 60);
  floor.polygon({{-2.0, 0.0}, {-2.0, 0.1}, {-2.1, 0.1}, {-2.1, 0.0}}, SemanticClass::kPillar, 60);
  floor.polygon({{-4.0, -0.3}, {-4.0, 0.3}, {-4.4, 0.3}, {-4.4, -0.3}}, SemanticClass::kPillar, 60);
  floor.labels.labels.setTo(0, finderOf(floor).find(floor.labels) == SemanticFrame::kSmear);
  const LabelProbe probe(floor.labels);
  EXPECT_EQ(probe.at({4.2, 0.5}), SemanticClass::kWall);
  EXPECT_EQ(probe.at({4.5, 0.5}), SemanticClass::kUnknown);
  EXPECT_EQ(probe.at({-4.2, 0.05}), SemanticClass::kPillar);
}

constexpr double kEye = 1.0;  // m, height of the camera in the picture's middle

struct Scene {
  PaintedFloor floor;
  Vector2d eye = floor.labels.geometry.center;
  cv::Mat smear;

  // Something that begins and ends so far ahead of the eye.
  void stand(double begin, double end, double half_width, SemanticClass c) {
    floor.polygon({eye + Vector2d(begin, -half_width), eye + Vector2d(end, -half_width),
                   eye + Vector2d(end, half_width), eye + Vector2d(begin, half_width)},
                  c, 200);
  }
  void hide(const std::vector<Vector3d>& raised) {
    const BevGeometry& g = floor.labels.geometry;
    std::vector<RaisedPoint> points;
    for (const Vector3d& p : raised) points.push_back({points.size(), p});
    smear = SmearFinder(g, BevViews::fromMiddle(g, kEye), {}).find(floor.labels, points);
  }
  [[nodiscard]] bool hidden(double x, double y) const {
    const Vector2d q = floor.labels.geometry.toPixel({x, y});
    return smear.at<std::uint8_t>(static_cast<int>(std::lround(q.y())),
                                  static_cast<int>(std::lround(q.x()))) == SemanticFrame::kSmear;
  }
};

TEST(SmearOfRaisedPoints, ReachesFromTheirFootToWhereTheyAreDrawn) {
  Scene scene;
  const Vector2d eye = scene.eye;
  scene.hide({{eye.x() + 3.0, eye.y(), 0.5}});  // drawn at 6 m
  EXPECT_FALSE(scene.hidden(eye.x() + 2.8, 0.0));
  for (const double r : {3.1, 4.5, 5.9}) {
    EXPECT_TRUE(scene.hidden(eye.x() + r, eye.y())) << r;
    EXPECT_TRUE(scene.hidden(eye.x() + r, eye.y() + 0.15 * r / 3.0)) << r;
    EXPECT_FALSE(scene.hidden(eye.x() + r, eye.y() + 0.4 * r / 3.0)) << r;
  }
  EXPECT_FALSE(scene.hidden(eye.x() + 6.2, eye.y()));
  EXPECT_FALSE(scene.hidden(eye.x() - 4.0, eye.y()));
}

TEST(SmearOfRaisedPoints, AboveTheCameraTheySayNothing) {
  Scene scene;
  const Vector2d eye = scene.eye;
  scene.hide({{eye.x() + 3.0, eye.y(), 2.0}});
  EXPECT_EQ(cv::countNonZero(scene.smear), 0);
}

TEST(SmearOfRaisedPoints, StructureThatBeginsAmidItStandsElsewhere) {
  Scene scene;
  const Vector2d eye = scene.eye;
  scene.stand(4.5, 5.0, 1.0, SemanticClass::kWall);
  scene.hide({{eye.x() + 3.0, eye.y(), 0.5}});  // drawn at 6 m
  EXPECT_TRUE(scene.hidden(eye.x() + 4.6, eye.y()));
  EXPECT_FALSE(scene.hidden(eye.x() + 4.6, eye.y() + 0.8));
}

TEST(SmearOfRaisedPoints, ThoseOfStructureThatIsLabelledSayNothingNew) {
  Scene scene;
  const Vector2d eye = scene.eye;
  scene.stand(3.1, 3.3, 0.2, SemanticClass::kPillar);
  scene.hide({{eye.x() + 3.0, eye.y(), 0.5}});
  EXPECT_FALSE(scene.hidden(eye.x() + 4.5, eye.y()));
}

TEST(SmearOfRaisedPoints, WhatIsLabelledUprightStays) {
  Scene scene;
  const Vector2d eye = scene.eye;
  scene.stand(3.5, 4.0, 1.0, SemanticClass::kVehicle);
  scene.hide({{eye.x() + 3.0, eye.y(), 0.6}});
  EXPECT_TRUE(scene.hidden(eye.x() + 3.2, eye.y()));
  EXPECT_FALSE(scene.hidden(eye.x() + 3.75, eye.y()));
  EXPECT_TRUE(scene.hidden(eye.x() + 4.3, eye.y()));
}

}  // namespace
}  // namespace parkade
