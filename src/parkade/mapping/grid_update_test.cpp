// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <chrono>

#include "parkade/mapping/global_map.hpp"
#include "parkade/mapping/local_map.hpp"
#include "parkade/mapping/synthetic_plan.hpp"

namespace parkade {
namespace {

using testing::makePlan;
using testing::PlanObserver;

TEST(FrameEvidence, WholeStepsEqualAddEvidence) {
  Random random(3);
  for (int round = 0; round < 2000; ++round) {
    GridCell a;
    GridCell b;
    for (int k = 0; k < 6; ++k) {
      const auto c = static_cast<SemanticClass>(random.integer(1, 3));
      const int steps = random.integer(1, 60);
      addEvidence(a, c, static_cast<float>(steps) * GridCell::kStep);
      addSteps(b, c, steps);
      ASSERT_EQ(a, b) << "after " << k;
    }
  }
}

TEST(FrameEvidence, SmearSaysNothing) {
  SemanticFrame frame;
  const BevGeometry& g = frame.labels.geometry;
  frame.labels.labels = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(1));
  frame.labels.labels.at<std::uint8_t>(7, 9) = static_cast<std::uint8_t>(SemanticClass::kPillar);
  frame.smear = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(0));
  frame.smear.at<std::uint8_t>(7, 9) = SemanticFrame::kSmear;
  const auto at = static_cast<std::size_t>(7 * g.width_px + 9);
  EXPECT_EQ(packLabels(frame).pixels[at], 0);
  EXPECT_NE(packLabels(frame).pixels[at + 1], 0);
  frame.smear = cv::Mat();
  EXPECT_EQ(PackedLabels::classOf(packLabels(frame).pixels[at]), SemanticClass::kPillar);
}

// The cell 2 m before the car's middle after pictures of it that all show one class everywhere.
struct ManyPictures {
  LocalMap map{LocalMapOptions()};
  TimeNs t_ns = 0;

  void show(SemanticClass c, int pictures, std::uint8_t smear = 0) {
    SemanticFrame frame;
    const BevGeometry& g = frame.labels.geometry;
    frame.labels.labels =
        cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(static_cast<int>(c)));
    frame.smear = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(smear));
    for (int k = 0; k < pictures; ++k) map.update(packLabels(frame), t_ns += 100'000'000, SE2());
  }
  [[nodiscard]] SemanticClass at(GridLayer layer) const {
    return map.at(layer, {40, 0}).semantic_class;
  }
  [[nodiscard]] bool knows(GridLayer layer, double border_m) const {
    const BevGeometry g;
    const double y = g.center.y() + 0.5 * g.width_px * g.metres_per_px - border_m;
    const Eigen::Vector2d p(g.center.x(), y);
    return map.at(layer, (p / 0.05).array().floor().cast<int>()).known();
  }
};

TEST(FrameEvidence, APicturesBorderDoesNotTellWallsFromFloor) {
  ManyPictures wall;
  wall.show(SemanticClass::kWall, 1);
  EXPECT_FALSE(wall.knows(GridLayer::kZoneMarkers, 0.5));
  EXPECT_TRUE(wall.knows(GridLayer::kZoneMarkers, 0.7));
  ManyPictures pillar;
  pillar.show(SemanticClass::kPillar, 1);
  EXPECT_TRUE(pillar.knows(GridLayer::kZoneMarkers, 0.1));
  ManyPictures floor;
  floor.show(SemanticClass::kFloor, 1);
  EXPECT_FALSE(floor.knows(GridLayer::kZoneMarkers, 0.3));
  EXPECT_TRUE(floor.knows(GridLayer::kZoneMarkers, 0.5));
  EXPECT_TRUE(floor.knows(GridLayer::kParkingLines, 0.1));
}

TEST(FrameEvidence, FloorOverrulesWhatLiesBehindAnEdge) {
  ManyPictures foot;
  foot.show(SemanticClass::kPillar, 3);
  foot.show(SemanticClass::kFloor, 1);
  EXPECT_EQ(foot.at(GridLayer::kZoneMarkers), SemanticClass::kPillar);
  ManyPictures hidden;
  hidden.show(SemanticClass::kPillar, 3, SemanticFrame::kBehindEdge);
  EXPECT_EQ(hidden.at(GridLayer::kZoneMarkers), SemanticClass::kPillar);
  hidden.show(SemanticClass::kFloor, 1);
  EXPECT_EQ(hidden.at(GridLayer::kZoneMarkers), SemanticClass::kFloor);
}

TEST(FrameEvidence, PaintMayBeMissedInSomePictures) {
  ManyPictures line;
  line.show(SemanticClass::kSlotLine, 1);
  line.show(SemanticClass::kFloor, 3);
  EXPECT_EQ(line.at(GridLayer::kParkingLines), SemanticClass::kSlotLine);
  line.show(SemanticClass::kFloor, 6);
  EXPECT_EQ(line.at(GridLayer::kParkingLines), SemanticClass::kFloor);
  ManyPictures arrow;
  arrow.show(SemanticClass::kArrow, 1);
  arrow.show(SemanticClass::kFloor, 3);
  EXPECT_EQ(arrow.at(GridLayer::kRoadMarkers), SemanticClass::kArrow);
  ManyPictures car;
  car.show(SemanticClass::kVehicle, 1);
  car.show(SemanticClass::kFloor, 3);
  EXPECT_EQ(car.at(GridLayer::kAvailability), SemanticClass::kFloor);
}

TEST(FrameEvidence, FloorThatMayBePaintSaysNothingAgainstIt) {
  // One picture that shows an arrow, then many of floor, with paint so many log-odds below it.
  const auto told = [](double below, double edge_m) {
    ManyPictures arrow;
    arrow.show(SemanticClass::kArrow, 1);
    SemanticFrame frame;
    const BevGeometry& g = frame.labels.geometry;
    frame.labels.labels = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(1));
    frame.labels.paint = cv::Mat(g.height_px, g.width_px, CV_8UC1,
                                 cv::Scalar(std::max(0.0, 255.0 - kEvidencePerLogOdds * below)));
    const Eigen::Vector2d beside = g.toPixel({2.025, 0.025 + edge_m});
    frame.labels.labels.at<std::uint8_t>(static_cast<int>(std::lround(beside.y())),
                                         static_cast<int>(std::lround(beside.x()))) =
        static_cast<std::uint8_t>(SemanticClass::kArrow);
    for (int k = 0; k < 10; ++k) {
      arrow.map.update(packLabels(frame), arrow.t_ns += 100'000'000, SE2());
    }
    EXPECT_EQ(arrow.at(GridLayer::kAvailability), SemanticClass::kFloor);
    return arrow.at(GridLayer::kRoadMarkers);
  };
  EXPECT_EQ(told(3.0, 0.3), SemanticClass::kArrow);
  EXPECT_EQ(told(8.0, 0.3), SemanticClass::kFloor);
  // What is labelled as paint has blurred edges.
  EXPECT_EQ(told(3.0, 0.08), SemanticClass::kFloor);
}

TEST(LocalMap, ShowsWhatIsAroundAndForgetsWhatLeaves) {
  const PlanObserver observer(makePlan(2, 60.0, 0.5, 1), {});
  LocalMapOptions options;
  options.size_m = 20.0;
  LocalMap map(options);
  Random random(1);
  for (int k = 0; k <= 60; ++k) {
    const SE2 pose(0.0, {10.0 + 0.5 * k, 0.0});
    map.update(packLabels(observer.observe(100'000'000LL * k, pose, random, true)),
               100'000'000LL * k, pose);
  }
  int lines = 0;
  int right = 0;
  for (int j = map.lowest().y(); j < map.lowest().y() + map.cells(); ++j) {
    for (int i = map.lowest().x(); i < map.lowest().x() + map.cells(); ++i) {
      const GridCell cell = map.at(GridLayer::kParkingLines, {i, j});
      if (cell.semantic_class != SemanticClass::kSlotLine) continue;
      ++lines;
      const Eigen::Vector2d p = map.resolution() * Eigen::Vector2d(i + 0.5, j + 0.5);
      // Within a cell's diagonal of the paint.
      bool near = false;
      for (const double d : {-0.04, 0.0, 0.04}) {
        near = near || observer.classAt(p + Eigen::Vector2d(d, 0)) == SemanticClass::kSlotLine ||
               observer.classAt(p + Eigen::Vector2d(0, d)) == SemanticClass::kSlotLine;
      }
      right += near ? 1 : 0;
    }
  }
  EXPECT_GT(lines, 1000);
  EXPECT_GT(right, 0.99 * lines);
  // The start lies 30 m behind, outside of the square.
  EXPECT_FALSE(map.contains({200, 0}));
  EXPECT_FALSE(map.at(GridLayer::kAvailability, {200, 0}).known());
}

TEST(LocalMap, MovingCarsAreDynamicAndFade) {
  PlanObserver observer(makePlan(1, 40.0, 0.0, 2), {});
  observer.plan().movers.push_back({{18.0, 1.0}, 0.3});
  LocalMap map({});
  Random random(2);
  const SE2 pose(0.0, {12.0, 0.0});
  map.update(packLabels(observer.observe(0, pose, random, true)), 0, pose);
  const Eigen::Vector2i cell(360, 20);
  EXPECT_EQ(map.at(GridLayer::kDynamic, cell).semantic_class, SemanticClass::kVehicle);
  EXPECT_NE(map.at(GridLayer::kAvailability, cell).semantic_class, SemanticClass::kVehicle);
  // It drives away: the ground is seen where it was.
  observer.plan().movers.clear();
  for (int k = 1; k <= 30; ++k) {
    const TimeNs t_ns = 100'000'000LL * k;
    map.update(packLabels(observer.observe(t_ns, pose, random, true)), t_ns, pose);
  }
  EXPECT_NE(map.at(GridLayer::kDynamic, cell).semantic_class, SemanticClass::kVehicle);
  EXPECT_EQ(map.at(GridLayer::kAvailability, cell).semantic_class, SemanticClass::kFloor);
}

struct Drive {
  std::vector<PackedLabels> labels;
  std::vector<SE2> poses;
};

Drive driveAlong(const PlanObserver& observer) {
  Drive drive;
  Random random(4);
  for (int k = 0; k < 40; ++k) {
    drive.poses.emplace_back(0.02 * k, Eigen::Vector2d(10.0 + 0.4 * k, 0.05 * k));
    drive.labels.push_back(
        packLabels(observer.observe(100'000'000LL * k, drive.poses.back(), random, true)));
  }
  return drive;
}

TEST(GlobalMap, ParkedCarsAreNotFreeAndRoadMarkersHaveTheirLayer) {
  const PlanObserver observer(makePlan(1, 60.0, 0.5, 5), {});
  const Drive drive = driveAlong(observer);
  GlobalMap map({});
  map.setAnchor(0, SE2());
  for (std::size_t k = 0; k < drive.poses.size(); ++k) {
    EXPECT_TRUE(
        map.update(drive.labels[k], 100'000'000LL * static_cast<int>(k), 0, drive.poses[k]));
  }
  const LayeredGrid& grid = map.grid();
  int wrong = 0;
  int known = 0;
  const auto bounds = grid.bounds(GridLayer::kAvailability);
  ASSERT_TRUE(bounds);
  for (int j = bounds->min.y(); j <= bounds->max.y(); ++j) {
    for (int i = bounds->min.x(); i <= bounds->max.x(); ++i) {
      const GridCell cell = grid.at(GridLayer::kAvailability, {i, j});
      if (!cell.known()) continue;
      ++known;
      const bool car = observer.classAt(grid.centerOf({i, j})) == SemanticClass::kVehicle;
      wrong += (cell.semantic_class == SemanticClass::kVehicle) != car ? 1 : 0;
    }
  }
  EXPECT_GT(known, 50000);
  EXPECT_LT(wrong, 0.01 * known);
  const auto& arrow = observer.classAt({18.0, -1.2});
  if (arrow == SemanticClass::kArrow) {
    EXPECT_EQ(grid.at(GridLayer::kRoadMarkers, grid.cellOf({18.0, -1.2})).semantic_class, arrow);
  }
  EXPECT_TRUE(grid.tiles(GridLayer::kDynamic).empty());
}

TEST(GlobalMap, CorrectedAnchorsGiveTheGridOfTheRightPoses) {
  const PlanObserver observer(makePlan(1, 60.0, 0.5, 5), {});
  const Drive drive = driveAlong(observer);
  // Anchor 1 starts wrong by 0.4 m and 2 degrees, and is corrected half way.
  const SE2 T_map_anchor(0.1, {14.0, 0.0});
  const SE2 wrong = T_map_anchor * SE2(0.035, {0.4, 0.1});
  GlobalMap corrected({});
  GlobalMap right({});
  for (GlobalMap* map : {&corrected, &right}) map->setAnchor(0, SE2());
  corrected.setAnchor(1, wrong);
  right.setAnchor(1, T_map_anchor);
  for (std::size_t k = 0; k < drive.poses.size(); ++k) {
    const TimeNs t_ns = 100'000'000LL * static_cast<int>(k);
    const bool first = k < 15;
    const SE2 local = first ? drive.poses[k] : T_map_anchor.inverse() * drive.poses[k];
    if (k == 25) corrected.setAnchor(1, T_map_anchor);
    corrected.update(drive.labels[k], t_ns, first ? 0 : 1, local);
    right.update(drive.labels[k], t_ns, first ? 0 : 1, local);
  }
  EXPECT_FALSE(corrected.rebuilding());
  EXPECT_TRUE(corrected.grid() == right.grid());
  right.finish();
  EXPECT_TRUE(corrected.grid() == right.grid());
}

TEST(GlobalMap, StandingCarEntersOnePicturePerSecond) {
  const PlanObserver observer(makePlan(1, 40.0, 0.5, 6), {});
  Random random(1);
  const SE2 pose(0.0, {12.0, 0.0});
  const PackedLabels labels = packLabels(observer.observe(0, pose, random, true));
  GlobalMap map({});
  map.setAnchor(0, SE2());
  for (int k = 0; k <= 50; ++k) map.update(labels, 100'000'000LL * k, 0, pose);
  EXPECT_EQ(map.pictures(), 6);
  EXPECT_LT(map.pictureBytes(), 6U * 30000U);
}

TEST(GlobalMap, AStandOfHoursKeepsAFewPictures) {
  const PlanObserver observer(makePlan(1, 40.0, 0.5, 6), {});
  Random random(1);
  const SE2 pose(0.0, {12.0, 0.0});
  const PackedLabels labels = packLabels(observer.observe(0, pose, random, true));
  GlobalMapOptions options;
  options.rebuild_per_frame = 2;
  GlobalMap map(options);
  map.setAnchor(0, SE2());
  for (int k = 0; k <= 200; ++k) map.update(labels, 1'000'000'000LL * k, 0, pose, k == 0);
  EXPECT_EQ(map.pictures(), 6);
  const SE2 further(0.0, {14.0, 0.0});
  for (int k = 201; k <= 203; ++k) map.update(labels, 1'000'000'000LL * k, 0, further, k == 201);
  EXPECT_EQ(map.pictures(), 9);
  // Rebuilt while it stands, it holds what it held.
  const auto cells = [&] {
    std::size_t known = 0;
    map.grid().forEachKnown(GridLayer::kParkingLines,
                            [&](const auto&, const GridCell&) { ++known; });
    return known;
  };
  const std::size_t before = cells();
  map.setAnchor(0, SE2(0.0, {0.5, 0.0}));
  EXPECT_TRUE(map.rebuilding());
  for (int k = 204; map.rebuilding() && k < 300; ++k) {
    map.update(labels, 1'000'000'000LL * k, 0, further, false);
  }
  EXPECT_FALSE(map.rebuilding());
  EXPECT_GT(before, 100U);
  EXPECT_NEAR(static_cast<double>(cells()), static_cast<double>(before), 0.05 * before);
}

// Prints the time only: whatever else a machine does must not fail a test.
TEST(GridUpdate, TimeOfAPictureIsTold) {
  const PlanObserver observer(makePlan(1, 60.0, 0.5, 5), {});
  const Drive drive = driveAlong(observer);
  LocalMap local({});
  GlobalMap global({});
  global.setAnchor(0, SE2());
  using Clock = std::chrono::steady_clock;
  std::vector<double> times;
  for (std::size_t k = 0; k < drive.poses.size(); ++k) {
    const TimeNs t_ns = 100'000'000LL * static_cast<int>(k);
    const auto begin = Clock::now();
    local.update(drive.labels[k], t_ns, drive.poses[k]);
    global.update(drive.labels[k], t_ns, 0, drive.poses[k]);
    times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
  }
  std::nth_element(times.begin(), times.begin() + 20, times.end());
  RecordProperty("median_ms", std::to_string(times[20]));
  std::printf("local and global map: %.2f ms per picture (median)\n", times[20]);
  EXPECT_TRUE(global.grid().bounds().has_value());
}

}  // namespace
}  // namespace parkade
