// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/object_registry.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "parkade/mapping/objects/label_sight.hpp"
#include "parkade/mapping/objects/level_view_test_support.hpp"

namespace parkade {
namespace {

ObjectObservation observed(SemanticClass semantic_class, const Eigen::Vector3d& position,
                           const std::string& text = "") {
  ObjectObservation o;
  o.semantic_class = semantic_class;
  o.position = position;
  o.covariance = 0.01 * Eigen::Matrix3d::Identity();
  o.text = text;
  o.confidence = 0.95;
  return o;
}

TEST(ObjectRegistry, SignsAreToldWhereCamerasPicturesShowThem) {
  ObjectObservation seen;
  seen.semantic_class = SemanticClass::kGuideSign;
  seen.position = {5.0, 1.0, 2.2};
  seen.covariance = 0.04 * Eigen::Matrix3d::Identity();
  seen.confidence = 0.9;
  const LevelView empty = testing::emptyLevelView();
  LevelView shown = testing::emptyLevelView();
  testing::drawColumn(shown, seen.position.head<2>(), 0.8, SemanticClass::kGuideSign, 2.0, 2.4);
  const auto told = [&](int hits, int misses) {
    ObjectRegistry registry({});
    registry.update({seen}, SE2(), 0.0, 0);
    for (int k = 0; k < hits; ++k) registry.update({}, SE2(), 0.0, 0, nullptr, {shown});
    for (int k = 0; k < misses; ++k) registry.update({}, SE2(), 0.0, 0, nullptr, {empty});
    return registry.objects().size();
  };
  EXPECT_EQ(told(0, 0), 1U);  // without such pictures
  EXPECT_EQ(told(2, 0), 0U);
  EXPECT_EQ(told(4, 0), 1U);
  EXPECT_EQ(told(4, 2), 1U);
  EXPECT_EQ(told(4, 20), 0U);
}

TEST(ObjectRegistry, ASignThatIsMeasuredLateIsFoundInThePicturesBefore) {
  const ObjectObservation seen = observed(SemanticClass::kGuideSign, {5.0, 1.0, 2.2});
  LevelView shown = testing::emptyLevelView();
  testing::drawColumn(shown, seen.position.head<2>(), 0.8, SemanticClass::kGuideSign, 2.0, 2.4);
  // Three pictures, a correction of the way, and the sign measured from where the car is then.
  const auto told = [&](int pictures, double correction, double measured) {
    ObjectRegistry registry({});
    for (int k = 0; k < pictures; ++k) registry.update({}, SE2(), 0.0, 0, nullptr, {shown});
    registry.moveWithAnchors([&](std::int64_t) { return SE2(0.0, {0.0, correction}); });
    registry.raise(measured > 0.0 ? 0.5 : 0.0);
    const SE2 T_world_vehicle(0.0, {0.0, measured});
    registry.update({seen}, T_world_vehicle, measured > 0.0 ? 0.5 : 0.0, 0, nullptr,
                    {testing::emptyLevelView({0.0, 0.0, 20.0})});
    return registry.objects().size();
  };
  EXPECT_EQ(told(3, 0.0, 0.0), 1U);
  EXPECT_EQ(told(2, 0.0, 0.0), 0U);
  EXPECT_EQ(told(3, 3.0, 3.0), 1U);
  EXPECT_EQ(told(3, 3.0, 0.0), 0U);
}

TEST(ObjectRegistry, OfTwoSignsThatHangNoFartherApartThanOneIsOffOneIsTold) {
  ObjectRegistry registry({});
  const ObjectObservation sign = observed(SemanticClass::kSpeedLimitSign, {5.0, 1.0, 2.2}, "10");
  const ObjectObservation beside = observed(SemanticClass::kSpeedLimitSign, {5.0, 1.9, 2.2}, "10");
  const ObjectObservation other = observed(SemanticClass::kSpeedLimitSign, {5.0, 3.5, 2.2}, "10");
  registry.update({sign, beside, other}, SE2(), 0.0, 0);
  registry.update({sign, other}, SE2(), 0.0, 0);
  const std::vector<MapObject> objects = registry.objects();
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_NEAR(objects[0].position.y(), 1.0, 1e-6);
  EXPECT_NEAR(objects[1].position.y(), 3.5, 1e-6);
}

TEST(ObjectRegistry, ALimitIsToldWithItsNumber) {
  const auto told = [](SemanticClass sign, const std::string& text) {
    ObjectRegistry registry({});
    registry.update({observed(sign, {5.0, 1.0, 2.2}, text)}, SE2(), 0.0, 0);
    return registry.objects().size();
  };
  EXPECT_EQ(told(SemanticClass::kSpeedLimitSign, "10"), 1U);
  EXPECT_EQ(told(SemanticClass::kSpeedLimitSign, ""), 0U);
  EXPECT_EQ(told(SemanticClass::kGuideSign, ""), 1U);
}

TEST(ObjectRegistry, AMarkerThatWasPassedIsMeasuredAgainOrStandsOnAPillar) {
  const ObjectObservation marker = observed(SemanticClass::kZoneMarker, {12.0, 3.0, 1.6}, "B1");
  const ObjectObservation pillar = observed(SemanticClass::kPillar, {12.4, 3.0, 0.0});
  // The marker is seen at the start of a straight way.
  const auto told = [&](double way, int looks, int pillars) {
    ObjectRegistry registry({});
    for (int k = 0; k <= static_cast<int>(way); ++k) {
      std::vector<ObjectObservation> seen;
      const SE2 T_world_vehicle(0.0, {static_cast<double>(k), 0.0});
      for (ObjectObservation o : {marker, pillar}) {
        if (k >= (o.semantic_class == SemanticClass::kPillar ? pillars : looks)) continue;
        o.position.x() -= k;
        seen.push_back(o);
      }
      registry.update(seen, T_world_vehicle, 0.0, k);
    }
    // Whatever the anchors do, what was passed stays so.
    registry.moveWithAnchors([](std::int64_t) { return SE2(1.0, {100.0, 50.0}); });
    std::size_t markers = 0;
    for (const MapObject& object : registry.objects()) {
      markers += object.semantic_class == SemanticClass::kZoneMarker ? 1 : 0;
    }
    return markers;
  };
  EXPECT_EQ(told(2.0, 1, 0), 1U);  // not passed
  EXPECT_EQ(told(14.0, 1, 0), 0U);
  EXPECT_EQ(told(14.0, 2, 0), 1U);
  EXPECT_EQ(told(14.0, 1, 2), 0U);  // no pillar yet
  EXPECT_EQ(told(14.0, 1, 4), 1U);
}

TEST(ObjectRegistry, AMarkerMeasuredOnceHangsWhereItsPillarStands) {
  const ObjectObservation marker = observed(SemanticClass::kZoneMarker, {12.0, 3.0, 1.6}, "B1");
  const ObjectObservation pillar = observed(SemanticClass::kPillar, {13.2, 3.1, 0.0});
  const auto told = [&](int looks, bool another) {
    ObjectRegistry registry({});
    for (int k = 0; k < 4; ++k) {
      std::vector<ObjectObservation> seen = {pillar};
      if (k < looks) seen.push_back(marker);
      if (another) seen.push_back(observed(SemanticClass::kZoneMarker, {13.2, 3.1, 1.6}, "B2"));
      registry.update(seen, SE2(), 0.0, k);
    }
    for (const MapObject& object : registry.objects()) {
      if (object.text == "B1") return object.position;
    }
    return Eigen::Vector3d(Eigen::Vector3d::Zero());
  };
  EXPECT_NEAR((told(1, false) - Eigen::Vector3d(13.2, 3.1, 1.6)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((told(2, false) - marker.position).norm(), 0.0, 1e-9);
  EXPECT_NEAR((told(1, true) - marker.position).norm(), 0.0, 1e-9);  // that is another's
}

TEST(ObjectRegistry, OfTwoMarkersThatBearOneTextTheOneMeasuredMoreIsTold) {
  const ObjectObservation marker = observed(SemanticClass::kZoneMarker, {20.0, 3.0, 1.6}, "B1");
  const auto told = [&](const std::string& other, double apart, bool on_pillar) {
    ObjectRegistry registry({});
    for (int k = 0; k < 4; ++k) {
      ObjectObservation misplaced = marker;
      misplaced.text = other;
      misplaced.position.x() += apart;
      std::vector<ObjectObservation> seen = {marker};
      if (k == 0) seen.push_back(misplaced);
      if (on_pillar) seen.push_back(observed(SemanticClass::kPillar, misplaced.position));
      registry.update(seen, SE2(), 0.0, k);
    }
    std::vector<MapObject> markers = registry.objects();
    std::erase_if(markers, [](const MapObject& object) {
      return object.semantic_class != SemanticClass::kZoneMarker;
    });
    return markers;
  };
  const std::vector<MapObject> one = told("B1", 1.4, false);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_NEAR(one[0].position.x(), 20.0, 1e-9);
  EXPECT_EQ(told("B2", 1.4, false).size(), 2U);
  EXPECT_EQ(told("B1", 2.5, true).size(), 2U);   // another pillar
  EXPECT_EQ(told("B1", 4.0, false).size(), 1U);  // bearings to different ones
  EXPECT_EQ(told("B2", 4.0, false).size(), 2U);
}

// A floor with a 1 m x 0.5 m stop line at (4, 0), labelled for a part of its width.
BevLabels stopLineLabels(double share) {
  BevLabels labels;
  labels.labels = cv::Mat(labels.geometry.height_px, labels.geometry.width_px, CV_8UC1,
                          cv::Scalar(static_cast<int>(SemanticClass::kFloor)));
  for (int v = 0; v < labels.labels.rows; ++v) {
    for (int u = 0; u < labels.labels.cols; ++u) {
      const Eigen::Vector2d p = labels.geometry.toGround({u, v});
      if (std::abs(p.x() - 4.0) > 0.25 || std::abs(p.y()) > 0.5) continue;
      const bool own = p.y() < -0.5 + share;
      labels.labels.at<std::uint8_t>(v, u) =
          static_cast<std::uint8_t>(own ? SemanticClass::kStopLine : SemanticClass::kLaneLine);
    }
  }
  return labels;
}

ObjectObservation stopLine(double x) {
  ObjectObservation o;
  o.semantic_class = SemanticClass::kStopLine;
  o.position = {x, 0.0, 0.0};
  o.covariance = 4e-4 * Eigen::Matrix3d::Identity();
  o.confidence = 0.9;
  o.outline = {{x - 0.25, -0.5}, {x + 0.25, -0.5}, {x + 0.25, 0.5}, {x - 0.25, 0.5}};
  return o;
}

// Objects told after 40 pictures, of which every n-th gave the observation.
std::size_t toldAfter(int every, const BevLabels& labels, double x = 4.0) {
  ObjectRegistry registry({});
  for (int k = 0; k < 40; ++k) {
    std::vector<ObjectObservation> seen;
    if (k % every == 0) seen.push_back(stopLine(x));
    registry.update(seen, SE2(), 0.0, 0, &labels);
  }
  return registry.objects().size();
}

TEST(ObjectRegistry, ToldWhereAllPicturesOfThePlaceAgree) {
  EXPECT_EQ(toldAfter(2, stopLineLabels(1.0)), 1U);
  EXPECT_EQ(toldAfter(8, stopLineLabels(1.0)), 0U);       // missed in plain sight
  EXPECT_EQ(toldAfter(2, stopLineLabels(0.2)), 0U);       // by its labels another kind of paint
  EXPECT_EQ(toldAfter(2, stopLineLabels(1.0), 9.0), 0U);  // never in plain sight
}

TEST(ObjectRegistry, HiddenObjectsAreNotMissed) {
  const BevLabels plain = stopLineLabels(1.0);
  BevLabels hidden = plain;
  hidden.labels = plain.labels.clone();
  hidden.labels.setTo(static_cast<int>(SemanticClass::kVehicle));
  ObjectRegistry registry({});
  for (int k = 0; k < 4; ++k) registry.update({stopLine(4.0)}, SE2(), 0.0, 0, &plain);
  for (int k = 0; k < 100; ++k) registry.update({}, SE2(), 0.0, 0, &hidden);
  EXPECT_EQ(registry.objects().size(), 1U);
  for (int k = 0; k < 100; ++k) registry.update({}, SE2(), 0.0, 0, &plain);
  EXPECT_TRUE(registry.objects().empty());
}

TEST(ObjectRegistry, OfTwoOnOnePlaceTheBetterSeenIsTold) {
  const BevLabels labels = stopLineLabels(1.0);
  ObjectRegistry registry({});
  for (int k = 0; k < 12; ++k) {
    std::vector<ObjectObservation> seen = {stopLine(4.0)};
    if (k % 2 == 0) seen.push_back(stopLine(4.2));
    registry.update(seen, SE2(), 0.0, 0, &labels);
  }
  const std::vector<MapObject> objects = registry.objects();
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_NEAR(objects[0].position.x(), 4.0, 0.05);
}

// A pillar of 0.6 m on the floor, and how a bird's-eye picture shows it.
ObjectObservation pillarAt(const Eigen::Vector2d& p) {
  ObjectObservation o;
  o.semantic_class = SemanticClass::kPillar;
  o.position << p, 0.0;
  o.covariance = 4e-4 * Eigen::Matrix3d::Identity();
  o.confidence = 0.9;
  for (const auto& corner : {Eigen::Vector2d(-0.3, -0.3), Eigen::Vector2d(0.3, -0.3),
                             Eigen::Vector2d(0.3, 0.3), Eigen::Vector2d(-0.3, 0.3)}) {
    o.outline.emplace_back(p + corner);
  }
  return o;
}

BevLabels pillarLabels(const std::vector<Eigen::Vector2d>& places) {
  BevLabels labels;
  labels.labels = cv::Mat(labels.geometry.height_px, labels.geometry.width_px, CV_8UC1,
                          cv::Scalar(static_cast<int>(SemanticClass::kFloor)));
  for (int v = 0; v < labels.labels.rows; ++v) {
    for (int u = 0; u < labels.labels.cols; ++u) {
      for (const Eigen::Vector2d& place : places) {
        const Eigen::Vector2d d = labels.geometry.toGround({u, v}) - place;
        if (d.cwiseAbs().maxCoeff() > 0.3) continue;
        labels.labels.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(SemanticClass::kPillar);
      }
    }
  }
  return labels;
}

TEST(ObjectRegistry, PillarsAreConfirmedOrRefutedByCamerasOwnPictures) {
  const Eigen::Vector2d place(4.0, 1.5);
  const BevLabels labels = pillarLabels({place});
  const auto told = [&](const std::vector<LevelView>& views) {
    ObjectRegistry registry({});
    for (int k = 0; k < 6; ++k) {
      registry.update({pillarAt(place)}, SE2(), 0.0, 0, &labels, views);
    }
    return registry.objects().size();
  };
  EXPECT_EQ(told({}), 1U);  // no such pictures: the bird's-eye view alone
  const LevelView plain = testing::emptyLevelView();
  EXPECT_EQ(told({plain}), 0U);
  LevelView shown = testing::emptyLevelView();
  testing::drawColumn(shown, place, 0.3, SemanticClass::kPillar);
  EXPECT_EQ(told({shown}), 1U);
  // One that looks elsewhere says nothing, but there has to be one that shows it.
  LevelView elsewhere = plain;
  elsewhere.labels = cv::Mat(plain.labels.size(), CV_8UC1, cv::Scalar(LevelView::kNotSeen));
  EXPECT_EQ(told({elsewhere}), 0U);
  EXPECT_EQ(told({shown, elsewhere}), 1U);
  EXPECT_EQ(told({shown, plain, plain}), 0U);
}

TEST(ObjectRegistry, APillarDoesNotSpeakForWhatLiesBehindIt) {
  const Eigen::Vector2d place(3.5, 0.0);
  const Eigen::Vector2d smear(6.3, 0.2);
  const BevLabels labels = pillarLabels({place, smear});
  LevelView view = testing::emptyLevelView();
  testing::drawColumn(view, place, 0.3, SemanticClass::kPillar);
  const auto told = [&](const std::vector<LevelView>& views) {
    ObjectRegistry registry({});
    for (int k = 0; k < 12; ++k) {
      std::vector<ObjectObservation> seen = {pillarAt(place)};
      if (k % 2 == 1) seen.push_back(pillarAt(smear));
      registry.update(seen, SE2(), 0.0, 0, &labels, views);
    }
    return registry.objects();
  };
  EXPECT_EQ(told({}).size(), 2U);
  const std::vector<MapObject> objects = told({view});
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_NEAR(objects[0].position.x(), 3.5, 0.05);
  // A second pillar that another eye sees by itself is told.
  LevelView beside = testing::emptyLevelView({2.0, 5.0, 0.9});
  testing::drawColumn(beside, smear, 0.3, SemanticClass::kPillar);
  testing::drawColumn(beside, place, 0.3, SemanticClass::kPillar);
  EXPECT_EQ(told({view, beside}).size(), 2U);
}

TEST(LabelSight, SharesOfAnArea) {
  const BevLabels labels = stopLineLabels(0.5);
  const LabelSight sight(labels, 8.5);
  const auto area = [](double x0, double x1) {
    return std::vector<Eigen::Vector2d>{{x0, -0.5}, {x1, -0.5}, {x1, 0.5}, {x0, 0.5}};
  };
  const AreaShares inside = sight.of(area(3.75, 4.25), SemanticClass::kStopLine);
  EXPECT_NEAR(inside.own, 0.5, 0.08);
  EXPECT_NEAR(inside.rival, 0.5, 0.08);
  EXPECT_NEAR(inside.unseen, 0.0, 1e-9);
  EXPECT_NEAR(sight.of(area(2.0, 3.0), SemanticClass::kStopLine).floor, 1.0, 1e-9);
  EXPECT_NEAR(sight.of(area(7.2, 8.2), SemanticClass::kStopLine).unseen, 0.5, 0.1);  // past 7.68 m
  EXPECT_NEAR(sight.of({}, SemanticClass::kStopLine).unseen, 1.0, 1e-9);
}

TEST(Votes, MarkersAreCalledAlike) {
  Votes votes;
  votes.add("106", 2.0);
  votes.add("10G", 0.9);
  Votes alone;
  alone.add("116", 1.0);
  TextFormat format;
  for (int i = 0; i < 3; ++i) format.add(std::to_string(i) + "G");
  EXPECT_EQ(votes.best(format), "106");  // three markers are no scheme
  for (int i = 3; i < 8; ++i) format.add(std::to_string(i) + "G");
  format.add("106");
  EXPECT_EQ(votes.best(), "106");
  EXPECT_EQ(votes.best(format), "10G");
  EXPECT_EQ(alone.best(format), "");
}

TEST(Votes, GateIsTheChiSquareOfFourDegrees) {
  EXPECT_NEAR(chiSquareGate4(0.95), 9.488, 1e-3);
  EXPECT_NEAR(chiSquareGate4(0.999), 18.467, 1e-3);
}

}  // namespace
}  // namespace parkade
