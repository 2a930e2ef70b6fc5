// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/map_evaluation.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "parkade/core/random.hpp"
#include "parkade/eval/map_picture.hpp"
#include "parkade/eval/map_report.hpp"

namespace parkade {
namespace {

// A row of slots along x above an aisle at y = 0, painted lines 0.12 m wide, an arrow, a marker on
// a pillar. The drive runs along the aisle.
MapTruth rowTruth(int count) {
  MapTruth truth;
  for (int i = 0; i < count; ++i) {
    const double x = 2.5 * i;
    TruthSlot slot;
    slot.corners = {Eigen::Vector2d(x, 3.0), Eigen::Vector2d(x + 2.5, 3.0),
                    Eigen::Vector2d(x + 2.5, 8.0), Eigen::Vector2d(x, 8.0)};
    slot.number = std::to_string(i + 1);
    slot.zone = "A1";
    slot.occupied = i % 2 == 0;
    truth.slots.push_back(slot);
  }
  for (int i = 0; i <= count; ++i) {
    const double x = 2.5 * i;
    truth.areas.push_back({SemanticClass::kSlotLine,
                           {{x - 0.06, 3.0}, {x + 0.06, 3.0}, {x + 0.06, 8.0}, {x - 0.06, 8.0}}});
  }
  truth.objects.push_back({SemanticClass::kArrow, {5.0, 0.0, 0.0}, "straight", {}, 1});
  truth.objects.push_back(
      {SemanticClass::kZoneMarker, {0.0, 7.5, 1.7}, "A1", {Eigen::Vector2d(0.0, -1.0)}, 4});
  for (int k = 0; k <= 10 * count; ++k) {
    truth.driven.push_back({100'000'000LL * (k + 1), SE3(SO3(), {0.25 * k, 0.0, 0.0})});
  }
  return truth;
}

// The map that says just that, in another frame.
ParkingMap perfectMap(const MapTruth& truth, const SE2& T_truth_map) {
  ParkingMap map;
  const SE2 T = T_truth_map.inverse();
  for (const TruthSlot& real : truth.slots) {
    MapSlot slot;
    slot.id = static_cast<std::int64_t>(map.slots.size()) + 1;
    for (std::size_t k = 0; k < 4; ++k) slot.corners[k] = T * real.corners[k];
    slot.number = real.number;
    slot.zone = real.zone;
    slot.probability_free = real.occupied ? 0.02 : 0.98;
    slot.last_seen_ns = 1'000'000'000;
    map.slots.push_back(slot);
  }
  for (const TruthObject& real : truth.objects) {
    MapObject object;
    object.id = static_cast<std::int64_t>(map.objects.size()) + 1;
    object.semantic_class = real.semantic_class;
    object.position.head<2>() = T * Eigen::Vector2d(real.position.head<2>());
    object.text = real.text;
    map.objects.push_back(object);
  }
  // Cells as a flawless observer fills them: by the truth at their middles.
  for (int i = -300; i < 700; ++i) {
    for (int j = -300; j < 300; ++j) {
      const Eigen::Vector2d p = map.grid.centerOf({i, j});
      const Eigen::Vector2d q = T_truth_map * p;
      if (q.x() < -1.0 || q.x() > 12.0 || q.y() < 0.0 || q.y() > 9.0) continue;
      const double off = q.x() - 2.5 * std::round(q.x() / 2.5);
      const bool line = q.y() > 3.0 && q.y() < 8.0 && std::abs(off) < 0.06;
      map.grid.add(GridLayer::kParkingLines, p,
                   line ? SemanticClass::kSlotLine : SemanticClass::kFloor, 3.0F);
      const int slot = static_cast<int>(std::floor(q.x() / 2.5));
      const bool car = q.y() > 3.2 && q.y() < 7.8 && slot % 2 == 0;
      map.grid.add(GridLayer::kAvailability, p,
                   car ? SemanticClass::kVehicle : SemanticClass::kFloor, 3.0F);
    }
  }
  return map;
}

MapEvaluation evaluated(const ParkingMap& map, const SE2& T_truth_map, const MapTruth& truth) {
  return evaluateMap(map, T_truth_map, truth).value();
}

const SE2 kPlace(0.3, {4.0, -2.0});

TEST(MapEvaluation, PerfectMapHasPerfectScores) {
  const MapTruth truth = rowTruth(4);
  const MapEvaluation e = evaluated(perfectMap(truth, kPlace), kPlace, truth);
  EXPECT_EQ(e.slots.passed, 4);
  EXPECT_EQ(e.slots.found, 4);
  EXPECT_EQ(e.slots.told, 4);
  EXPECT_EQ(e.slots.recall, 1.0);
  EXPECT_EQ(e.slots.precision, 1.0);
  EXPECT_EQ(e.slots.duplicates, 0);
  EXPECT_NEAR(e.slots.corner_error.max, 0.0, 1e-9);
  EXPECT_EQ(e.slots.availability, 1.0);
  EXPECT_EQ(e.slots.numbers_right, 4);
  EXPECT_EQ(e.slots.zones_right, 4);
  EXPECT_GT(e.layers.at(GridLayer::kParkingLines).iou, 0.95);
  EXPECT_EQ(e.layers.at(GridLayer::kParkingLines).tolerant_iou, 1.0);
  EXPECT_GT(e.layers.at(GridLayer::kAvailability).iou, 0.99);
  EXPECT_EQ(e.objects.at(SemanticClass::kArrow).found, 1);
  EXPECT_EQ(e.objects.at(SemanticClass::kArrow).wrong, 0);
  EXPECT_EQ(e.objects.at(SemanticClass::kZoneMarker).texts_right, 1);
}

TEST(MapEvaluation, SlotHalfwayBetweenMarkersMayHaveEitherZone) {
  MapTruth truth = rowTruth(3);
  ParkingMap map = perfectMap(truth, kPlace);
  truth.slots[2].zone = "A2";
  // As far from the middle slot as A1 is.
  truth.objects.push_back({SemanticClass::kZoneMarker, {7.5, 7.5, 1.7}, "A2", {}, 4});
  for (MapSlot& slot : map.slots) slot.zone = "A2";
  EXPECT_EQ(evaluated(map, kPlace, truth).slots.zones_right, 2);  // not the first
}

TEST(MapEvaluation, TellsHowFarCornersAreOffAndWhatAFitLeaves) {
  const MapTruth truth = rowTruth(4);
  ParkingMap map = perfectMap(truth, kPlace);
  for (MapSlot& slot : map.slots) {
    for (Eigen::Vector2d& corner : slot.corners) corner += Eigen::Vector2d(0.03, 0.04);
  }
  const MapEvaluation e = evaluated(map, kPlace, truth);
  EXPECT_EQ(e.slots.found, 4);
  EXPECT_NEAR(e.slots.entrance_error.median, 0.05, 1e-9);
  EXPECT_NEAR(e.slots.fitted_entrance_error.max, 0.0, 1e-9);
}

TEST(MapEvaluation, CountsMissedWrongAndRepeatedSlots) {
  const MapTruth truth = rowTruth(6);
  ParkingMap map = perfectMap(truth, SE2());
  map.slots.erase(map.slots.begin() + 2);  // missed
  MapSlot twice = map.slots[0];            // the same again, a little off
  twice.id = 50;
  for (Eigen::Vector2d& corner : twice.corners) corner.y() += 0.1;
  map.slots.push_back(twice);
  MapSlot invented = map.slots[0];  // across the aisle, where none is
  invented.id = 51;
  for (Eigen::Vector2d& corner : invented.corners) corner.y() -= 11.0;
  map.slots.push_back(invented);
  const MapEvaluation e = evaluated(map, SE2(), truth);
  EXPECT_EQ(e.slots.found, 5);
  EXPECT_EQ(e.slots.passed, 6);
  EXPECT_THAT(e.missed, testing::ElementsAre(2));
  EXPECT_EQ(e.slots.told, 7);
  EXPECT_EQ(e.slots.wrong, 2);
  EXPECT_EQ(e.slots.duplicates, 1);
}

TEST(MapEvaluation, RowShiftedByASlotIsMissedAtItsEndAndWronglyNumbered) {
  const MapTruth truth = rowTruth(6);
  ParkingMap map = perfectMap(truth, SE2());
  for (MapSlot& slot : map.slots) {
    for (Eigen::Vector2d& corner : slot.corners) corner.x() += 2.5;
  }
  const MapEvaluation e = evaluated(map, SE2(), truth);
  EXPECT_EQ(e.slots.found, 5);
  EXPECT_EQ(e.slots.wrong, 1);
  EXPECT_EQ(e.slots.numbers_right, 0);
  EXPECT_EQ(e.slots.numbers_wrong, 5);
  EXPECT_EQ(e.slots.availability_right, 0);  // every other slot is occupied
}

TEST(MapEvaluation, SlotsTurnedRoundAreNotFound) {
  const MapTruth truth = rowTruth(4);
  ParkingMap map = perfectMap(truth, SE2());
  for (MapSlot& slot : map.slots) {
    slot.corners = {slot.corners[2], slot.corners[3], slot.corners[0], slot.corners[1]};
  }
  EXPECT_EQ(evaluated(map, SE2(), truth).slots.found, 0);
}

TEST(MapEvaluation, WrongAndOpenAvailabilityAndParkedMoversCount) {
  MapTruth truth = rowTruth(4);
  ParkingMap map = perfectMap(truth, SE2());
  map.slots[0].probability_free = 0.5;
  map.slots[1].probability_free = 0.02;  // free in truth
  MapEvaluation e = evaluated(map, SE2(), truth);
  EXPECT_EQ(e.slots.availability_open, 1);
  EXPECT_EQ(e.slots.availability_right, 2);
  truth.vehicles.push_back({map.slots[1].last_seen_ns, {3.75, 5.5}});  // one stands in it
  e = evaluated(map, SE2(), truth);
  EXPECT_EQ(e.slots.availability_right, 3);
}

TEST(MapEvaluation, OnlyWhatWasPassedIsJudged) {
  MapTruth truth = rowTruth(20);
  const ParkingMap map = perfectMap(rowTruth(4), SE2());
  truth.driven.resize(1);  // never left x = 0
  const MapEvaluation e = evaluated(map, SE2(), truth);
  EXPECT_EQ(e.slots.passed, 3);  // entrances at 1.25, 3.75 and 6.25 m, 3 m aside
  EXPECT_EQ(e.slots.found, 3);
  EXPECT_EQ(e.slots.told, 3);
}

TEST(MapEvaluation, SlotsOutOfSightAreCountedApart) {
  MapTruth truth =
      rowTruth(5);  // the map has seen the floor to x = 12 m, the last one ends at 12.5
  ParkingMap map = perfectMap(rowTruth(4), SE2());
  MapEvaluation e = evaluated(map, SE2(), truth);
  EXPECT_EQ(e.slots.passed, 5);
  EXPECT_EQ(e.slots.in_sight, 4);
  EXPECT_EQ(e.slots.recall, 0.8);
  EXPECT_EQ(e.slots.recall_in_sight, 1.0);
  map.slots.erase(map.slots.begin());
  e = evaluated(map, SE2(), truth);
  EXPECT_EQ(e.slots.recall_in_sight, 0.75);
}

TEST(MapEvaluation, ObjectsOfOtherClassesOrTextsAreWrong) {
  const MapTruth truth = rowTruth(4);
  ParkingMap map = perfectMap(truth, SE2());
  map.objects[0].semantic_class = SemanticClass::kStopLine;
  map.objects[1].text = "B1";
  const MapEvaluation e = evaluated(map, SE2(), truth);
  EXPECT_EQ(e.objects.at(SemanticClass::kArrow).found, 0);
  EXPECT_EQ(e.objects.at(SemanticClass::kStopLine).wrong, 1);
  EXPECT_EQ(e.objects.at(SemanticClass::kZoneMarker).found, 1);
  EXPECT_EQ(e.objects.at(SemanticClass::kZoneMarker).texts_right, 0);
}

TEST(MapEvaluation, LayersOffByOneCellAreForgivenByTheTolerantFigureOnly) {
  const MapTruth truth = rowTruth(4);
  const ParkingMap map = perfectMap(truth, SE2());
  const auto iou = [&](double shift) {
    return evaluated(map, SE2(0.0, {shift, 0.0}), truth).layers.at(GridLayer::kParkingLines);
  };
  EXPECT_LT(iou(0.05).iou, 0.6);
  EXPECT_GT(iou(0.05).tolerant_iou, 0.98);
  EXPECT_LT(iou(0.2).iou, 0.05);
  EXPECT_LT(iou(0.2).tolerant_iou, 0.05);
}

TEST(MapEvaluation, TruthBeyondTheLayersCellsIsNotSeen) {
  const ParkingMap map = perfectMap(rowTruth(4), SE2());  // to x = 12 m
  const auto score = [&](const MapTruth& truth) {
    return evaluated(map, SE2(), truth).layers.at(GridLayer::kParkingLines);
  };
  EXPECT_EQ(score(rowTruth(4)).seen, 1.0);
  EXPECT_NEAR(score(rowTruth(8)).seen, 5.0 / 9.0, 0.01);  // lines from 0 to 10 m of those to 20 m
  EXPECT_EQ(score(rowTruth(8)).iou, score(rowTruth(4)).iou);
  EXPECT_EQ(score(rowTruth(8)).tolerant_iou, score(rowTruth(4)).tolerant_iou);
}

TEST(MapEvaluation, StrayCellFarAwayIsAnErrorAndNoHugePicture) {
  const MapTruth truth = rowTruth(4);
  ParkingMap map = perfectMap(truth, SE2());
  const MapEvaluation e = evaluated(map, SE2(), truth);
  map.grid.set(GridLayer::kRoadMarkers, {400'000, 400'000}, SemanticClass::kArrow, 3.0F);
  map.grid.set(GridLayer::kRoadMarkers, {0, 0}, SemanticClass::kArrow, 3.0F);
  const Result<MapEvaluation> stray = evaluateMap(map, SE2(), truth);
  ASSERT_FALSE(stray.ok());
  EXPECT_THAT(stray.error().message, testing::HasSubstr("parkade map check"));
  EXPECT_FALSE(drawMapErrors(map, truth, e).ok());
}

TEST(MapEvaluation, EmptyMapScoresNothingAndBreaksNothing) {
  const MapTruth truth = rowTruth(4);
  const ParkingMap map;
  const MapEvaluation e = evaluated(map, SE2(), truth);
  EXPECT_EQ(e.slots.recall, 0.0);
  EXPECT_EQ(e.slots.precision, 0.0);
  EXPECT_EQ(e.layers.at(GridLayer::kParkingLines).iou, 0.0);
  EXPECT_FALSE(drawMapErrors(map, truth, e).ok());
  EXPECT_TRUE(nlohmann::json::accept(mapEvaluationJson(e)));
  EXPECT_THAT(mapEvaluationTable(e), testing::HasSubstr("recall"));
}

TEST(MapEvaluation, PictureShowsTheErrorsInTheirColours) {
  const MapTruth truth = rowTruth(4);
  ParkingMap map = perfectMap(truth, SE2());
  map.slots.pop_back();
  const MapEvaluation e = evaluated(map, SE2(), truth);
  const Result<cv::Mat> picture = drawMapErrors(map, truth, e);
  ASSERT_TRUE(picture.ok());
  int missed = 0;
  for (int row = 0; row < picture->rows; ++row) {
    for (int column = 0; column < picture->cols; ++column) {
      missed += picture->at<cv::Vec3b>(row, column) == cv::Vec3b(0, 130, 255);
    }
  }
  EXPECT_GT(missed, 500);  // 15 m of outline, 5 cells wide, at 20 cells a metre
}

TEST(MapEvaluation, MapIsPlacedByItsFirstPose) {
  const MapTruth truth = rowTruth(4);
  const SE3 T_map_vehicle(SO3::fromYawPitchRoll(0.2, 0.01, 0.0), {1.0, 2.0, 0.0});
  const Result<SE3> T = placeByFirstPose(truth.driven[3].t_ns, T_map_vehicle, truth.driven);
  ASSERT_TRUE(T.ok());
  const SE3 placed = *T * T_map_vehicle;
  const SE2 back = SE2::fromSE3(placed);
  EXPECT_NEAR(back.translation().x(), 0.75, 1e-9);
  EXPECT_NEAR(back.angle(), 0.0, 1e-9);
  EXPECT_NEAR(placed.translation().z(), truth.driven[3].T_world_body.translation().z(), 1e-9);
  EXPECT_FALSE(
      placeByFirstPose(truth.driven.back().t_ns + kNsPerSecond * 100, T_map_vehicle, truth.driven)
          .ok());
}

}  // namespace
}  // namespace parkade
