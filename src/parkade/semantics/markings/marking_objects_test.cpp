// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/markings/marking_objects.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/core/random.hpp"
#include "parkade/geometry/se2.hpp"

namespace parkade {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

class Floor {
 public:
  Floor() {
    labels.geometry.center = {1.4, 0.0};
    const BevGeometry& g = labels.geometry;
    labels.labels = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(1));
    labels.confidence = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(230));
    views = BevViews::fromMiddle(g);
  }
  void paint(SemanticClass c, const Polygon& polygon, const SE2& place = {}) {
    constexpr int kShift = 4;
    std::vector<cv::Point> pixels;
    for (const Eigen::Vector2d& p : polygon) {
      const Eigen::Vector2d q = labels.geometry.toPixel(place * p) * (1 << kShift);
      pixels.emplace_back(static_cast<int>(std::lround(q.x())),
                          static_cast<int>(std::lround(q.y())));
    }
    cv::fillPoly(labels.labels, std::vector<std::vector<cv::Point>>{pixels},
                 cv::Scalar(static_cast<int>(c)), 8, kShift);
  }
  BevLabels labels;
  BevViews views;
};

Polygon box(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

// An arrow about the middle of its length, along x.
std::vector<Polygon> arrow(const std::string& meaning, double length) {
  const bool straight = meaning.find("straight") != std::string::npos;
  const double s = length;
  std::vector<Polygon> out;
  const double bend = straight ? 0.0 : 0.32 * s;
  out.push_back(box(-0.5 * s, -0.04 * s, straight ? 0.2 * s : bend + 0.04 * s, 0.04 * s));
  if (straight) out.push_back({{0.2 * s, -0.12 * s}, {0.5 * s, 0.0}, {0.2 * s, 0.12 * s}});
  for (const double side : {1.0, -1.0}) {
    if (meaning.find(side > 0.0 ? "left" : "right") == std::string::npos) continue;
    out.push_back(box(bend - 0.04 * s, 0.0, bend + 0.04 * s, side * 0.14 * s));
    out.push_back({{bend - 0.12 * s, side * 0.14 * s},
                   {bend + 0.12 * s, side * 0.14 * s},
                   {bend, side * 0.4 * s}});
  }
  return out;
}

constexpr double kAttitudeSigma = 0.002;

TEST(MarkingObjects, ArrowsTellMeaningPlaceAndHeading) {
  const MarkingExtractor extractor({});
  Random random(7);
  for (const char* meaning : {"straight", "left", "right", "straight_left", "straight_right",
                              "left_right", "straight_left_right"}) {
    for (int k = 0; k < 12; ++k) {
      Floor floor;
      const double length = random.uniform(1.5, 3.2);
      const SE2 place(random.uniform(-M_PI, M_PI),
                      {random.uniform(3.0, 5.0), random.uniform(-4.0, 4.0)});
      for (const Polygon& p : arrow(meaning, length)) floor.paint(SemanticClass::kArrow, p, place);
      const auto objects = extractor.extract(floor.labels, floor.views, kAttitudeSigma);
      ASSERT_EQ(objects.size(), 1U) << meaning;
      EXPECT_EQ(objects[0].text, meaning) << length << " " << place.angle();
      EXPECT_LT(std::abs(wrapAngle(objects[0].heading - place.angle())), 0.06) << meaning;
      // Arrows that only turn end at their side heads' far corner, not at half a length.
      const bool straight = std::string(meaning).find("straight") != std::string::npos;
      const Eigen::Vector2d middle =
          place * Eigen::Vector2d(straight ? 0.0 : (-0.03 * length), 0.0);
      EXPECT_LT((objects[0].position.head<2>() - middle).norm(), 0.07) << meaning;
      EXPECT_GT(objects[0].covariance(0, 0), 1e-5);
      EXPECT_GT(objects[0].confidence, 0.5);
    }
  }
}

TEST(MarkingObjects, PaintThatHangsTogetherIsOneThing) {
  const MarkingExtractor extractor({});
  const SE2 place(0.4, {4.5, 1.0});
  const auto found = [&](double share, const std::vector<Polygon>& paint) {
    Floor floor;
    for (const Polygon& p : paint) floor.paint(SemanticClass::kLaneLine, p, place);
    const SE2 back = place.inverse();
    for (int v = 0; v < floor.labels.labels.rows; ++v) {
      for (int u = 0; u < floor.labels.labels.cols; ++u) {
        std::uint8_t& label = floor.labels.labels.at<std::uint8_t>(v, u);
        const double x = (back * floor.labels.geometry.toGround({u, v})).x();
        if (label != 1 && x > 1.2 - 2.4 * share) label = static_cast<std::uint8_t>(4);
      }
    }
    return extractor.extract(floor.labels, floor.views, kAttitudeSigma);
  };
  // Its shaft taken for a line's dash, an arrow is found whole; a dash with an arrow's end is none.
  const auto arrows = found(0.5, arrow("straight", 2.4));
  ASSERT_EQ(arrows.size(), 1U);
  EXPECT_LT((arrows[0].position.head<2>() - place.translation()).norm(), 0.1);
  EXPECT_EQ(arrows[0].text, "straight");
  EXPECT_TRUE(found(0.3, {box(-1.2, -0.08, 1.2, 0.08)}).empty());
  // And a plain bar is no arrow, whatever its labels say.
  EXPECT_TRUE(found(1.0, {box(-1.2, -0.08, 1.2, 0.08)}).empty());
}

TEST(MarkingObjects, WornArrowsAreStillRead) {
  const MarkingExtractor extractor({});
  Random random(3);
  for (const char* meaning : {"straight", "left", "straight_right"}) {
    Floor floor;
    const SE2 place(0.7, {4.5, 1.0});
    for (const Polygon& p : arrow(meaning, 2.4)) floor.paint(SemanticClass::kArrow, p, place);
    for (int k = 0; k < 150; ++k) {  // scratches of 3 x 3 pixels
      const int u = random.integer(1, floor.labels.labels.cols - 4);
      const int v = random.integer(1, floor.labels.labels.rows / 2);
      floor.labels.labels(cv::Rect(u, v, 3, 3)) = 1;
    }
    const auto objects = extractor.extract(floor.labels, floor.views, kAttitudeSigma);
    ASSERT_EQ(objects.size(), 1U) << meaning;
    EXPECT_EQ(objects[0].text, meaning);
    EXPECT_LT(std::abs(wrapAngle(objects[0].heading - 0.7)), 0.06) << meaning;
  }
}

TEST(MarkingObjects, ArrowsPartedByWearAreOne) {
  const MarkingExtractor extractor({});
  for (const char* meaning : {"straight", "left", "straight_right", "left_right"}) {
    Floor floor;
    const SE2 place(-0.5, {4.5, 1.0});
    for (const Polygon& p : arrow(meaning, 2.4)) floor.paint(SemanticClass::kArrow, p, place);
    // Half a metre of the shaft is gone.
    floor.paint(SemanticClass::kFloor, box(-0.5, -0.3, 0.0, 0.3), place);
    const auto objects = extractor.extract(floor.labels, floor.views, kAttitudeSigma);
    ASSERT_EQ(objects.size(), 1U) << meaning;
    EXPECT_EQ(objects[0].text, meaning);
    EXPECT_LT(std::abs(wrapAngle(objects[0].heading + 0.5)), 0.06) << meaning;
    EXPECT_LT((objects[0].position.head<2>() - place.translation()).norm(), 0.12) << meaning;
  }
}

TEST(MarkingObjects, ArrowsThatNearlyTouchAreTwo) {
  const MarkingExtractor extractor({});
  Floor floor;
  for (const double y : {-1.25, 1.25}) {
    const SE2 place(M_PI_2, {4.5, y});
    for (const Polygon& p : arrow("straight", 2.4)) floor.paint(SemanticClass::kArrow, p, place);
  }
  const auto objects = extractor.extract(floor.labels, floor.views, kAttitudeSigma);
  ASSERT_EQ(objects.size(), 2U);
  for (const ObjectObservation& o : objects) {
    EXPECT_EQ(o.text, "straight");
    EXPECT_NEAR(std::abs(o.position.y()), 1.25, 0.06);
  }
}

TEST(MarkingObjects, HeadsWithoutAShaftAreNoArrow) {
  const MarkingExtractor extractor({});
  Floor floor;
  const SE2 place(0.3, {4.5, 0.0});
  for (const Polygon& p : arrow("left_right", 2.8)) floor.paint(SemanticClass::kArrow, p, place);
  floor.paint(SemanticClass::kFloor, box(-1.5, -0.3, 0.78, 0.3), place);
  EXPECT_TRUE(extractor.extract(floor.labels, floor.views, kAttitudeSigma).empty());
  // Nor are two bars in a row, dashes of a line.
  Floor dashes;
  for (const double x : {-1.3, 0.2}) {
    dashes.paint(SemanticClass::kArrow, box(x, -0.08, x + 1.1, 0.08), place);
  }
  EXPECT_TRUE(extractor.extract(dashes.labels, dashes.views, kAttitudeSigma).empty());
}

TEST(MarkingObjects, WhatIsCutOffIsLeftOut) {
  const MarkingExtractor extractor({});
  Floor border;
  const double edge = border.labels.geometry.toGround({200.0, 0.0}).x();
  for (const Polygon& p : arrow("straight", 2.4)) {
    border.paint(SemanticClass::kArrow, p, SE2(0.0, {edge - 0.5, 0.0}));
  }
  EXPECT_TRUE(extractor.extract(border.labels, border.views, kAttitudeSigma).empty());
  Floor car;
  for (const Polygon& p : arrow("straight", 2.4)) {
    car.paint(SemanticClass::kArrow, p, SE2(0.0, {4.0, 0.0}));
  }
  car.paint(SemanticClass::kUnknown, box(1.0, -1.0, 3.2, 1.0));
  EXPECT_TRUE(extractor.extract(car.labels, car.views, kAttitudeSigma).empty());
  Floor hidden;
  for (const Polygon& p : arrow("straight", 2.4)) {
    hidden.paint(SemanticClass::kArrow, p, SE2(0.0, {4.0, 0.0}));
  }
  hidden.paint(SemanticClass::kVehicle, box(4.6, -1.0, 6.0, 1.0));
  EXPECT_TRUE(extractor.extract(hidden.labels, hidden.views, kAttitudeSigma).empty());
}

TEST(MarkingObjects, WheelStopsStandWhereTheirSmearBegins) {
  const MarkingExtractor extractor({});
  for (const double angle : {0.0, 0.5}) {
    Floor floor;
    const SE2 place(angle, {5.5, -1.0});
    // The camera is at the picture's middle, (1.4, 0): a body 0.12 m high reaches half a metre on,
    // into what is labelled a vehicle there.
    floor.paint(SemanticClass::kVehicle, box(0.4, -1.5, 1.5, 1.5), place);
    const Eigen::Vector2d away =
        (place.rotationMatrix().transpose() * (place.translation() - Eigen::Vector2d(1.4, 0.0)))
            .normalized();
    for (double smear = 0.5; smear >= 0.0; smear -= 0.02) {
      Polygon body = box(-0.08, -0.85, 0.08, 0.85);
      for (Eigen::Vector2d& p : body) p += smear * away;
      floor.paint(SemanticClass::kWheelStop, body, place);
    }
    const auto objects = extractor.extract(floor.labels, floor.views, kAttitudeSigma);
    ASSERT_EQ(objects.size(), 1U) << angle;
    EXPECT_EQ(objects[0].semantic_class, SemanticClass::kWheelStop);
    EXPECT_LT((objects[0].position.head<2>() - place.translation()).norm(), 0.1) << angle;
  }
}

TEST(MarkingObjects, BoxesLieOnTheirPaint) {
  const MarkingExtractor extractor({});
  struct Case {
    SemanticClass c;
    double along, across;
  };
  for (const Case& item :
       {Case{SemanticClass::kStopLine, 0.3, 2.6}, Case{SemanticClass::kSpeedBump, 0.35, 5.2},
        Case{SemanticClass::kWheelStop, 0.16, 1.7}}) {
    for (const double angle : {0.0, 0.4, 1.1}) {
      Floor floor;
      const SE2 place(angle, {5.0, -1.0});
      floor.paint(item.c,
                  box(-0.5 * item.along, -0.5 * item.across, 0.5 * item.along, 0.5 * item.across),
                  place);
      const auto objects = extractor.extract(floor.labels, floor.views, kAttitudeSigma);
      ASSERT_EQ(objects.size(), 1U);
      EXPECT_LT((objects[0].position.head<2>() - place.translation()).norm(), 0.03);
      ASSERT_EQ(objects[0].outline.size(), 4U);
      const Eigen::Vector2d side = objects[0].outline[1] - objects[0].outline[0];
      EXPECT_NEAR(side.norm(), item.across, 0.09);
      EXPECT_LT(std::abs(side.normalized().dot(Eigen::Vector2d(std::cos(angle), std::sin(angle)))),
                0.05);
      EXPECT_EQ(objects[0].sigma_heading, 0.0);
    }
  }
  Floor floor;
  const SE2 place(0.2, {4.6, 0.5});
  for (int bar = -3; bar <= 3; ++bar) {
    floor.paint(SemanticClass::kCrossing, box(-1.2, 0.9 * bar - 0.22, 1.2, 0.9 * bar + 0.22),
                place);
  }
  const auto objects = extractor.extract(floor.labels, floor.views, kAttitudeSigma);
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_LT((objects[0].position.head<2>() - place.translation()).norm(), 0.04);
}

TEST(MarkingObjects, LimitsAreReadAllAround) {
  const MarkingExtractor extractor({});
  // Strokes of a seven-segment kind: none of the shapes that the reader was made with.
  const std::map<char, std::vector<Polygon>> digits = {
      {'0',
       {box(0.0, 0.0, 0.12, 0.85), box(0.4, 0.0, 0.52, 0.85), box(0.0, 0.0, 0.52, 0.12),
        box(0.0, 0.73, 0.52, 0.85)}},
      {'1', {box(0.2, 0.0, 0.32, 0.85)}},
      {'2',
       {box(0.0, 0.73, 0.52, 0.85), box(0.4, 0.36, 0.52, 0.85), box(0.0, 0.36, 0.52, 0.48),
        box(0.0, 0.0, 0.12, 0.48), box(0.0, 0.0, 0.52, 0.12)}},
      {'5',
       {box(0.0, 0.73, 0.52, 0.85), box(0.0, 0.36, 0.12, 0.85), box(0.0, 0.36, 0.52, 0.48),
        box(0.4, 0.0, 0.52, 0.48), box(0.0, 0.0, 0.52, 0.12)}}};
  int read = 0;
  int all = 0;
  for (const std::string number : {"5", "10", "20"}) {
    for (int k = 0; k < 8; ++k) {
      Floor floor;
      const SE2 place(0.3 + k * M_PI / 4.0, {4.8, 1.0});
      constexpr int kSides = 32;
      for (int i = 0; i < kSides; ++i) {
        const auto at = [](int n, double r) {
          const double a = 2.0 * M_PI * n / kSides;
          return Eigen::Vector2d(r * std::cos(a), r * std::sin(a));
        };
        floor.paint(SemanticClass::kSpeedLimitPaint,
                    {at(i, 0.77), at(i, 0.9), at(i + 1, 0.9), at(i + 1, 0.77)}, place);
      }
      const double width = 0.66 * static_cast<double>(number.size()) - 0.14;
      double x = -0.5 * width;
      for (const char digit : number) {
        for (Polygon p : digits.at(digit)) {
          for (Eigen::Vector2d& q : p) q = {q.y() - 0.425, -(q.x() + x)};  // up the page is ahead
          floor.paint(SemanticClass::kSpeedLimitPaint, p, place);
        }
        x += 0.66;
      }
      const auto objects = extractor.extract(floor.labels, floor.views, kAttitudeSigma);
      ASSERT_EQ(objects.size(), 1U);
      EXPECT_LT((objects[0].position.head<2>() - place.translation()).norm(), 0.05);
      ++all;
      if (objects[0].text == number) {
        ++read;
        EXPECT_LT(std::abs(wrapAngle(objects[0].heading - place.angle())), 0.15);
      } else {
        EXPECT_EQ(objects[0].text, "") << number << " at " << place.angle();
      }
    }
  }
  EXPECT_GE(read, all / 4);
}

}  // namespace
}  // namespace parkade
