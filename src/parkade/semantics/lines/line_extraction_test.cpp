// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/lines/line_extraction.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

#include "parkade/semantics/features_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

double aside(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = (b - a).normalized();
  return std::abs(along.x() * (p - a).y() - along.y() * (p - a).x());
}

// Root mean square and largest distance of all points from one line.
std::pair<double, double> errorsOf(const Lines& lines, const Vector2d& a, const Vector2d& b) {
  double sum = 0.0;
  double most = 0.0;
  for (const LinePoint& point : lines.points) {
    const double off = aside(point.p_level, a, b);
    sum += off * off;
    most = std::max(most, off);
  }
  return {std::sqrt(sum / static_cast<double>(lines.points.size())), most};
}

TEST(LineExtraction, MeasuresLinesOfAnyDirectionToAFractionOfAPixel) {
  for (int degrees = 0; degrees < 180; degrees += 9) {
    const double angle = degrees * M_PI / 180.0;
    const Vector2d along(std::cos(angle), std::sin(angle));
    const Vector2d a = Vector2d(1.63, 0.21) - 3.0 * along;
    const Vector2d b = a + 6.0 * along;
    PaintedFloor floor;
    floor.line(a, b);
    const Lines lines = extractLines(floor.bev, floor.labels, 0.0);
    ASSERT_GT(lines.points.size(), 60U) << degrees;
    EXPECT_LT(lines.points.size(), 110U) << degrees;
    const auto [rms, most] = errorsOf(lines, a, b);
    EXPECT_LT(rms, 0.006) << degrees;
    EXPECT_LT(most, 0.02) << degrees;
    ASSERT_EQ(lines.segments.size(), 1U) << degrees;
    const LineSegment& segment = lines.segments[0];
    EXPECT_NEAR((segment.end - segment.begin).norm(), 6.0, 0.2) << degrees;
    EXPECT_NEAR(segment.width, 0.12, 0.03) << degrees;
    EXPECT_LT(aside(segment.begin, a, b), 0.006) << degrees;
    EXPECT_LT(aside(segment.end, a, b), 0.006) << degrees;
    for (const LinePoint& point : lines.points) {
      EXPECT_LT(std::abs(point.normal.dot(along)), 0.15) << degrees;
      EXPECT_NEAR(point.normal.norm(), 1.0, 1e-9);
    }
  }
}

TEST(LineExtraction, NoiseStaysWithinItsSigma) {
  Random random(3);
  PaintedFloor floor;
  const Vector2d a(-4.0, 2.1);
  const Vector2d b(6.5, 3.3);
  floor.line(a, b);
  floor.addNoise(6.0, 0.3, random);
  const Lines lines = extractLines(floor.bev, floor.labels, 0.0);
  ASSERT_GT(lines.points.size(), 80U);
  const auto [rms, most] = errorsOf(lines, a, b);
  EXPECT_LT(rms, 0.012);
  EXPECT_LT(most, 0.06);
  double whitened = 0.0;
  for (const LinePoint& point : lines.points) {
    whitened += std::pow(aside(point.p_level, a, b) / point.sigma, 2);
  }
  EXPECT_LT(whitened / static_cast<double>(lines.points.size()), 1.5);
  ASSERT_EQ(lines.segments.size(), 1U);
  EXPECT_LT(aside(0.5 * (lines.segments[0].begin + lines.segments[0].end), a, b), 0.006);
}

TEST(LineExtraction, AttitudeMovesFarLinesMore) {
  PaintedFloor floor;
  floor.line({-4.0, 1.5}, {6.0, 1.5});
  floor.line({-4.0, 7.0}, {6.0, 7.0});
  const double sigma = 0.002;
  LineOptions options;
  options.sight_sigma_deg = 0.0;
  const Lines lines = extractLines(floor.bev, floor.labels, sigma, options);
  for (const LinePoint& point : lines.points) {
    const Vector2d ray = point.p_level - floor.bev.geometry.center;
    if (std::abs(ray.x()) > 0.1) continue;
    const double tilt = sigma * (ray.squaredNorm() + 1.0);
    EXPECT_NEAR(point.sigma, std::hypot(tilt, 0.25 * 0.04), 0.001);
  }
  ASSERT_EQ(lines.segments.size(), 2U);
  const bool first_near = lines.segments[0].begin.y() < 4.0;
  EXPECT_LT(lines.segments[first_near ? 0 : 1].sigma_offset, 0.01);
  EXPECT_GT(lines.segments[first_near ? 1 : 0].sigma_offset, 0.08);
}

TEST(LineExtraction, JoinsOverGapsAndPartsAtCorners) {
  PaintedFloor floor;
  floor.line({3.0, -5.0}, {3.0, 5.0});
  floor.line({3.0, 2.5}, {8.0, 2.5});
  floor.line({3.0, 0.0}, {8.0, 0.0});
  floor.polygon({{4.5, 2.0}, {5.0, 2.0}, {5.0, 3.0}, {4.5, 3.0}}, SemanticClass::kFloor, 90);
  const Lines lines = extractLines(floor.bev, floor.labels, 0.0);
  ASSERT_EQ(lines.segments.size(), 3U);
  for (const LineSegment& segment : lines.segments) {
    const bool across = std::abs(segment.end.y() - segment.begin.y()) > 5.0;
    EXPECT_NEAR((segment.end - segment.begin).norm(), across ? 10.0 : 5.0, 0.3);
  }
}

TEST(LineExtraction, TrustsNoEdgeOfAnOccluder) {
  PaintedFloor floor;
  const Vector2d a(-3.0, 2.0);
  const Vector2d b(5.0, 2.0);
  floor.line(a, b);
  floor.polygon({{0.0, 2.0}, {2.0, 2.02}, {2.0, 4.0}, {0.0, 4.0}}, SemanticClass::kVehicle, 30);
  const Lines lines = extractLines(floor.bev, floor.labels, 0.0);
  ASSERT_GT(lines.points.size(), 50U);
  const auto [rms, most] = errorsOf(lines, a, b);
  EXPECT_LT(rms, 0.005);
  EXPECT_LT(most, 0.03);
}

TEST(LineExtraction, LeavesTheLabelsAsTheyAre) {
  PaintedFloor floor;
  floor.line({3.0, -5.0}, {4.0, 5.0});
  const cv::Mat before = floor.labels.labels.clone();
  ASSERT_EQ(before.rows, before.cols);
  EXPECT_FALSE(extractLines(floor.bev, floor.labels, 0.0).points.empty());
  EXPECT_EQ(cv::norm(before, floor.labels.labels, cv::NORM_L1), 0.0);
}

TEST(LineExtraction, FollowsBends) {
  PaintedFloor floor;
  const Vector2d center(1.4, -4.0);
  floor.paint([&](const Vector2d& p) { return std::abs((p - center).norm() - 6.0) < 0.06; },
              SemanticClass::kLaneLine, 200);
  const Lines lines = extractLines(floor.bev, floor.labels, 0.0);
  ASSERT_GT(lines.points.size(), 100U);
  for (const LinePoint& point : lines.points) {
    EXPECT_EQ(point.semantic_class, SemanticClass::kLaneLine);
    EXPECT_NEAR((point.p_level - center).norm(), 6.0, 0.02);
  }
  EXPECT_GT(lines.segments.size(), 2U);
}

TEST(LineExtraction, IsQuick) {
  PaintedFloor floor;
  for (int i = -3; i <= 3; ++i) {
    floor.line({3.5, 2.5 * i}, {8.5, 2.5 * i});
    floor.line({-0.5, 2.5 * i}, {-5.5, 2.5 * i});
  }
  floor.line({3.5, -7.5}, {3.5, 7.5});
  floor.line({-0.5, -7.5}, {-0.5, 7.5});
  Random random(1);
  floor.addNoise(4.0, 0.2, random);
  double best = 1e9;
  std::size_t count = 0;
  for (int i = 0; i < 10; ++i) {
    const auto start = std::chrono::steady_clock::now();
    count = extractLines(floor.bev, floor.labels, 0.002).points.size();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count());
  }
  std::printf("  %zu points in %.2f ms\n", count, best);
  EXPECT_GT(count, 500U);
  EXPECT_LT(best, 40.0);  // far above what it takes: machines under load, sanitizers
}

}  // namespace
}  // namespace parkade
