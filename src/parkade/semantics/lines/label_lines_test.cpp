// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/lines/label_lines.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace parkade {
namespace {

// A line of 0.12 m through a ground point, drawn into labels.
BevLabels drawn(const Eigen::Vector2d& through, double angle, double half_length, double width) {
  BevLabels bev;
  const BevGeometry& g = bev.geometry;
  bev.labels = cv::Mat(g.height_px, g.width_px, CV_8UC1,
                       cv::Scalar(static_cast<int>(SemanticClass::kFloor)));
  bev.confidence = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(220));
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d across(-along.y(), along.x());
  for (int v = 0; v < g.height_px; ++v) {
    for (int u = 0; u < g.width_px; ++u) {
      const Eigen::Vector2d d =
          g.toGround({static_cast<double>(u), static_cast<double>(v)}) - through;
      if (std::abs(across.dot(d)) > 0.5 * width || std::abs(along.dot(d)) > half_length) continue;
      bev.labels.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(SemanticClass::kSlotLine);
    }
  }
  return bev;
}

std::vector<LinePoint> pointsOf(const BevLabels& bev, double attitude_sigma = 0.0) {
  return linePointsFromLabels(bev, BevViews::fromMiddle(bev.geometry), attitude_sigma, {});
}

TEST(LabelLines, PointsLieOnTheMiddleAndSegmentsAlongTheLine) {
  for (const double angle : {0.0, 0.3, 0.8, M_PI / 2.0, 2.5}) {
    const Eigen::Vector2d through(1.03, 2.017);
    const BevLabels bev = drawn(through, angle, 2.0, 0.12);
    const std::vector<LinePoint> points = pointsOf(bev);
    ASSERT_GT(points.size(), 15U) << angle;
    const Eigen::Vector2d across(-std::sin(angle), std::cos(angle));
    double squares = 0.0;
    for (const LinePoint& point : points) {
      const double off = across.dot(point.p_level - through);
      squares += off * off / static_cast<double>(points.size());
      EXPECT_LT(std::abs(off), 0.03) << angle;
      EXPECT_GT(std::abs(across.dot(point.normal)), 0.98) << angle;
    }
    EXPECT_LT(std::sqrt(squares), 0.012) << angle;
    const std::vector<LineSegment> segments = segmentsOf(points);
    ASSERT_GE(segments.size(), 1U) << angle;
    for (const LineSegment& segment : segments) {
      const Eigen::Vector2d d = (segment.end - segment.begin).normalized();
      EXPECT_LT(std::abs(across.dot(d)), 0.015) << angle;
    }
  }
}

// Two pixels wide, along the car and across it, at every offset against the pixels looked at.
TEST(LabelLines, NoOffsetHidesAThinLine) {
  for (const double angle : {0.0, M_PI / 2.0}) {
    for (int k = 0; k < 10; ++k) {
      const Eigen::Vector2d through(1.0 + 0.04 * k, 2.0 + 0.04 * k);
      EXPECT_GE(pointsOf(drawn(through, angle, 2.0, 0.08)).size(), 12U) << angle << " " << k;
    }
  }
}

// From h over the ground, d away, a tilt of a moves what lies across the line of sight's foot by
// a (d^2 + h^2) / h; from twice as high by about half.
TEST(LabelLines, SigmaKnowsTheCameraThatSeesThePoint) {
  const BevLabels bev = drawn({5.0, 0.0}, M_PI / 2.0, 1.0, 0.12);
  const double tilt = 0.01;
  for (const double height : {0.7, 1.4}) {
    const BevViews views = BevViews::fromMiddle(bev.geometry, height);
    for (const LinePoint& point : linePointsFromLabels(bev, views, tilt, {})) {
      const Eigen::Vector2d ray = point.p_level - bev.geometry.center;
      if (std::abs(ray.y()) > 0.1) continue;
      const double moved = tilt * (ray.squaredNorm() + height * height) / height;
      EXPECT_NEAR(point.sigma, std::hypot(moved, 0.35 * 0.04), 0.02 * moved);
    }
  }
}

TEST(LabelLines, WidePaintIsNoLine) {
  EXPECT_TRUE(pointsOf(drawn({1.0, 1.0}, 0.2, 1.0, 0.8)).empty());
  BevLabels unsure = drawn({1.0, 1.0}, 0.2, 2.0, 0.12);
  unsure.confidence = cv::Scalar(50);
  EXPECT_TRUE(pointsOf(unsure).empty());
}

}  // namespace
}  // namespace parkade
