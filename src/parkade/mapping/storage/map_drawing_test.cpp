// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/storage/map_drawing.hpp"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <set>

#include "parkade/mapping/map_test_support.hpp"

namespace parkade {
namespace {

using ::testing::HasSubstr;
using testing::sampleMap;

cv::Vec3b colourNamed(const std::vector<MapColour>& legend, std::string_view name) {
  for (const MapColour& colour : legend) {
    if (colour.name == name) return {colour.bgr[0], colour.bgr[1], colour.bgr[2]};
  }
  ADD_FAILURE() << name << " is in no legend";
  return {};
}

TEST(MapDrawing, PictureShowsFreeAndOccupiedSlots) {
  ParkingMap map = sampleMap();
  map.grid = LayeredGrid();
  const Result<cv::Mat> drawn = drawMap(map, 0.1);
  ASSERT_TRUE(drawn) << drawn.error().message;
  const cv::Mat& picture = *drawn;
  ASSERT_EQ(picture.cols, 150);
  ASSERT_EQ(picture.rows, 50);
  const auto free = picture.at<cv::Vec3b>(25, 12);
  const auto occupied = picture.at<cv::Vec3b>(25, 37);
  EXPECT_GT(free[1], free[2]);
  EXPECT_GT(occupied[2], occupied[1]);
}

TEST(MapDrawing, SignsAreSquaresOfTheirOwn) {
  ParkingMap map;
  MapSlot slot;
  slot.corners = {Eigen::Vector2d(0, 0), Eigen::Vector2d(4, 0), Eigen::Vector2d(4, 4),
                  Eigen::Vector2d(0, 4)};
  map.slots = {slot};
  MapObject sign;
  sign.semantic_class = SemanticClass::kGuideSign;
  sign.position = {1.0, 3.0, 2.2};
  map.objects = {sign};
  const Result<cv::Mat> picture = drawMap(map, 0.1);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->at<cv::Vec3b>(10, 10), colourNamed(mapLegend(), "guide sign"));
  EXPECT_NE(picture->at<cv::Vec3b>(10, 16), colourNamed(mapLegend(), "guide sign"));
}

TEST(MapDrawing, SignsOutsideOfThePictureAreLeftOut) {
  ParkingMap map = sampleMap();
  const Result<cv::Mat> without = drawMap(map, 0.1);
  ASSERT_TRUE(without);
  MapObject sign;
  sign.semantic_class = SemanticClass::kGuideSign;
  for (const double x : {-40.0, 400.0, 1e300, -1e300}) {
    sign.position = {x, x, 2.2};
    map.objects.push_back(sign);
  }
  const Result<cv::Mat> with = drawMap(map, 0.1);
  ASSERT_TRUE(with);
  ASSERT_EQ(with->size(), without->size());
  const cv::Mat changed = *with != *without;
  EXPECT_EQ(cv::countNonZero(changed.reshape(1)), 0);
}

TEST(MapDrawing, ALayersPictureHoldsThatLayerAloneInTheColoursOfItsLegend) {
  ParkingMap map;
  map.grid.add(GridLayer::kParkingLines, {0.02, 0.02}, SemanticClass::kSlotLine, 2.0F);
  map.grid.add(GridLayer::kParkingLines, {0.97, 0.97}, SemanticClass::kFloor, 2.0F);
  map.grid.add(GridLayer::kRoadMarkers, {0.52, 0.02}, SemanticClass::kArrow, 2.0F);
  const Result<cv::Mat> lines = drawLayer(map, GridLayer::kParkingLines);
  const Result<cv::Mat> markers = drawLayer(map, GridLayer::kRoadMarkers);
  ASSERT_TRUE(lines.ok() && markers.ok());
  ASSERT_EQ(lines->size(), cv::Size(20, 20));
  ASSERT_EQ(markers->size(), lines->size());
  const auto legend = layerLegend(GridLayer::kParkingLines);
  // Row 0 has the largest y.
  EXPECT_EQ(lines->at<cv::Vec3b>(19, 0), colourNamed(legend, "slot line"));
  EXPECT_EQ(lines->at<cv::Vec3b>(0, 19), colourNamed(legend, "seen, nothing there"));
  EXPECT_EQ(lines->at<cv::Vec3b>(19, 10), colourNamed(legend, "never seen"));
  EXPECT_EQ(markers->at<cv::Vec3b>(19, 10),
            colourNamed(layerLegend(GridLayer::kRoadMarkers), "arrow"));
  EXPECT_EQ(markers->at<cv::Vec3b>(19, 0), colourNamed(legend, "never seen"));
}

TEST(MapDrawing, ThinPaintStaysInASmallPicture) {
  // A line one cell wide, in the odd cells, which a picture of every second cell would miss.
  ParkingMap map;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      const SemanticClass c = j == 21 ? SemanticClass::kSlotLine : SemanticClass::kFloor;
      map.grid.add(GridLayer::kParkingLines, map.grid.centerOf({i, j}), c, 2.0F);
    }
  }
  const Result<cv::Mat> drawn = drawLayer(map, GridLayer::kParkingLines, 0.1);
  ASSERT_TRUE(drawn);
  ASSERT_EQ(drawn->rows, 20);
  const cv::Vec3b line = colourNamed(layerLegend(GridLayer::kParkingLines), "slot line");
  for (int v = 0; v < drawn->rows; ++v) {
    EXPECT_EQ(drawn->at<cv::Vec3b>(v, 7) == line, v == 9) << v;
  }
}

TEST(MapDrawing, OnlyTheAvailabilityLayerShowsSlots) {
  ParkingMap map = sampleMap();
  map.grid = LayeredGrid();
  for (const GridLayer layer : kGridLayers) {
    const Result<cv::Mat> drawn = drawLayer(map, layer, 0.1);
    ASSERT_TRUE(drawn);
    const cv::Vec3b middle = drawn->at<cv::Vec3b>(25, 12);
    const cv::Vec3b nothing = colourNamed(layerLegend(layer), "never seen");
    EXPECT_EQ(middle != nothing, layer == GridLayer::kAvailability);
  }
}

TEST(MapDrawing, TheLocalMapIsDrawnAroundTheCarNorthUp) {
  LocalMapOptions options;
  options.size_m = 8.0;
  LocalMap map(options);
  SemanticFrame frame;
  frame.labels.geometry.width_px = frame.labels.geometry.height_px = 100;
  frame.labels.labels = cv::Mat(100, 100, CV_8UC1, cv::Scalar(1));  // floor
  frame.labels.confidence = cv::Mat(100, 100, CV_8UC1, cv::Scalar(255));
  // An arrow ahead of the car; the car looks along y.
  frame.labels.labels(cv::Rect(45, 10, 10, 10)).setTo(static_cast<int>(SemanticClass::kArrow));
  map.update(packLabels(frame), 1, SE2(M_PI / 2, {10.0, 20.0}));
  const cv::Mat all = drawLocalMap(map);
  ASSERT_EQ(all.size(), cv::Size(map.cells(), map.cells()));
  const cv::Vec3b arrow = colourNamed(mapLegend(), "arrow");
  const cv::Vec3b floor = colourNamed(mapLegend(), "seen, nothing there");
  const int middle = map.cells() / 2;
  const int ahead = static_cast<int>((50 - 15) * 0.04 / map.resolution());
  EXPECT_EQ(all.at<cv::Vec3b>(middle - ahead, middle), arrow);
  EXPECT_EQ(all.at<cv::Vec3b>(middle + ahead, middle), floor);
  EXPECT_EQ(all.at<cv::Vec3b>(2, 2), colourNamed(mapLegend(), "never seen"));
  const cv::Mat lines = drawLocalMap(map, GridLayer::kParkingLines);
  EXPECT_EQ(lines.at<cv::Vec3b>(middle - ahead, middle), floor);
}

TEST(MapDrawing, ALegendNamesEachColourOnce) {
  for (const GridLayer layer : kGridLayers) {
    std::set<std::array<std::uint8_t, 3>> colours;
    for (const MapColour& colour : layerLegend(layer)) {
      EXPECT_TRUE(colours.insert(colour.bgr).second) << colour.name;
    }
  }
}

TEST(MapDrawing, MapOfAbsurdExtentIsRefused) {
  ParkingMap map = sampleMap();
  map.slots[0].corners[0] = {1e12, 0.0};
  EXPECT_THAT(drawMap(map).error().message, HasSubstr("pixels, more than"));
  EXPECT_THAT(drawLayer(map, GridLayer::kDynamic).error().message, HasSubstr("pixels, more than"));
}

TEST(MapDrawing, TheFinestPictureThatFitsIsTold) {
  ParkingMap map = sampleMap();
  EXPECT_DOUBLE_EQ(finestMetresPerPx(map), 0.01);
  EXPECT_DOUBLE_EQ(finestMetresPerPx(ParkingMap()), 0.01);
  map.grid = LayeredGrid();
  EXPECT_EQ(mapPictureSize(map, 0.1), Eigen::Vector2d(150.0, 50.0));
  // A square, and a strip that is too long for a PNG's side.
  for (const Eigen::Vector2d& far :
       {Eigen::Vector2d(9000.0, 9000.0), Eigen::Vector2d(600000.0, 3.0)}) {
    map.slots[0].corners[0] = far;
    const double finest = finestMetresPerPx(map);
    EXPECT_TRUE(checkPictureSize(mapPictureSize(map, finest)));
    EXPECT_FALSE(checkPictureSize(mapPictureSize(map, 0.95 * finest)));
  }
}

}  // namespace
}  // namespace parkade
