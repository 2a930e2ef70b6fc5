// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "parkade/core/random.hpp"
#include "parkade/types/bev_image.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// Floor to paint on, with what a perfect network and camera make of it.
class PaintedFloor {
 public:
  PaintedFloor() {
    const BevGeometry g = geometry();
    bev.geometry = g;
    labels.geometry = g;
    bev.image = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(90));
    bev.valid = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(255));
    labels.labels = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(1));
    labels.confidence = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(255));
  }
  static BevGeometry geometry() {
    BevGeometry g;
    g.center = {1.4, 0.0};
    return g;
  }

  /// A rectangle around the line from a to b that ends half a width beyond both.
  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width = 0.12,
            SemanticClass semantic_class = SemanticClass::kSlotLine, int grey = 190) {
    const Eigen::Vector2d along = (b - a).normalized();
    const Eigen::Vector2d normal(-along.y(), along.x());
    const double length = (b - a).norm();
    paint(
        [&](const Eigen::Vector2d& p) {
          const double s = along.dot(p - a);
          return std::abs(normal.dot(p - a)) <= 0.5 * width && s >= -0.5 * width &&
                 s <= length + 0.5 * width;
        },
        semantic_class, grey, around({a, b}, width));
  }

  /// Convex polygon, counter-clockwise.
  void polygon(const std::vector<Eigen::Vector2d>& corners, SemanticClass semantic_class,
               int grey) {
    paint(
        [&](const Eigen::Vector2d& p) {
          for (std::size_t i = 0; i < corners.size(); ++i) {
            const Eigen::Vector2d e = corners[(i + 1) % corners.size()] - corners[i];
            const Eigen::Vector2d d = p - corners[i];
            if (e.x() * d.y() - e.y() * d.x() < 0.0) return false;
          }
          return true;
        },
        semantic_class, grey, around(corners, 0.0));
  }

  /// Covers the share of every pixel that inside says; the label is that of the larger share.
  template <class Inside>
  void paint(const Inside& inside, SemanticClass semantic_class, int grey) {
    const BevGeometry& g = bev.geometry;
    paint(inside, semantic_class, grey, {0, 0, g.width_px, g.height_px});
  }
  template <class Inside>
  void paint(const Inside& inside, SemanticClass semantic_class, int grey, cv::Rect where) {
    constexpr int kSub = 5;
    const BevGeometry& g = bev.geometry;
    where &= cv::Rect(0, 0, g.width_px, g.height_px);
    for (int v = where.y; v < where.y + where.height; ++v) {
      for (int u = where.x; u < where.x + where.width; ++u) {
        int hits = 0;
        for (int k = 0; k < kSub * kSub; ++k) {
          const Eigen::Vector2d sub((k % kSub + 0.5) / kSub - 0.5, (k / kSub + 0.5) / kSub - 0.5);
          if (inside(g.toGround(Eigen::Vector2d(u, v) + sub))) ++hits;
        }
        if (hits == 0) continue;
        const double share = static_cast<double>(hits) / (kSub * kSub);
        auto& pixel = bev.image.at<std::uint8_t>(v, u);
        pixel = static_cast<std::uint8_t>(std::lround(pixel + share * (grey - pixel)));
        if (share >= 0.5) {
          labels.labels.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(semantic_class);
        }
      }
    }
  }

  /// Pixels that hold points and what lies margin (m) around them.
  static cv::Rect around(const std::vector<Eigen::Vector2d>& points, double margin) {
    cv::Rect rect;
    for (const Eigen::Vector2d& p : points) {
      const Eigen::Vector2d a = geometry().toPixel(p + Eigen::Vector2d::Constant(margin));
      const Eigen::Vector2d b = geometry().toPixel(p - Eigen::Vector2d::Constant(margin));
      rect |= cv::Rect(cv::Point(static_cast<int>(a.x()) - 2, static_cast<int>(a.y()) - 2),
                       cv::Point(static_cast<int>(b.x()) + 3, static_cast<int>(b.y()) + 3));
    }
    return rect;
  }

  /// Grey noise, and labels that frazzle: wherever a neighbour differs, one of the two by chance.
  void addNoise(double grey_sigma, double label_chance, Random& random) {
    const cv::Mat before = labels.labels.clone();
    for (int v = 1; v + 1 < before.rows; ++v) {
      for (int u = 1; u + 1 < before.cols; ++u) {
        auto& pixel = bev.image.at<std::uint8_t>(v, u);
        pixel = cv::saturate_cast<std::uint8_t>(pixel + grey_sigma * random.normal());
        if (!random.chance(label_chance)) continue;
        constexpr int kSteps[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
        const auto& step = kSteps[random.integer(0, 3)];
        labels.labels.at<std::uint8_t>(v, u) = before.at<std::uint8_t>(v + step[0], u + step[1]);
      }
    }
  }

  BevImage bev;
  BevLabels labels;
};

}  // namespace parkade
