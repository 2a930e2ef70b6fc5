// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace parkade {

/// A flat painted shape of any size, to be found again among ground points: in its own frame x
/// points ahead (up the page for text), y to the left, and it reaches from x = 0 to 1.
class MarkingShape {
 public:
  /// Union of polygons in any unit.
  MarkingShape(std::string meaning, const std::vector<std::vector<Eigen::Vector2d>>& polygons);
  /// Non-zero pixels of a CV_8UC1 picture: up is ahead.
  MarkingShape(std::string meaning, const cv::Mat& picture);

  [[nodiscard]] const std::string& meaning() const { return meaning_; }
  [[nodiscard]] double area() const { return area_; }  ///< shares of length^2
  [[nodiscard]] double low() const { return low_; }    ///< least y
  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] bool covers(double x, double y) const {
    const int i = static_cast<int>(x * kCells);
    const int j = static_cast<int>((y - low_) * kCells);
    return x >= 0.0 && y >= low_ && i < kCells && j < columns_ &&
           cells_[static_cast<std::size_t>(i * columns_ + j)] != 0;
  }

 private:
  static constexpr int kCells = 80;
  void fill(const cv::Mat& picture);

  std::string meaning_;
  std::vector<std::uint8_t> cells_;  ///< row by row from x = 0
  int columns_ = 0;
  double low_ = 0.0;
  double width_ = 0.0;
  double area_ = 0.0;
};

/// How a shape lies among points.
struct ShapeFit {
  int shape = -1;                                    ///< -1: none fits
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< of the shape's frame
  double heading = 0.0;                              ///< rad, of its x axis
  double length = 0.0;                               ///< m
  double overlap = 0.0;                              ///< intersection over union
  double next = 0.0;                                 ///< overlap of the best with another meaning
};

/// Ways of laying shapes over points.
struct ShapeSearch {
  double heading = 0.0;       ///< rad, middle of the headings tried, modulo turn
  double half_range = M_PI;   ///< rad, to both sides
  double turn = 2.0 * M_PI;   ///< rad: headings repeat by this (pi: both ways along an axis)
  double step = M_PI / 30.0;  ///< rad
  double min_length = 0.5;    ///< m
  double max_length = 6.0;    ///< m
  double width_slack = 0.25;  ///< share of its width that a shape may be off
  std::size_t points = 220;   ///< that are looked at, evenly of those given
};

/// The shape, place, size and heading that cover the points (pixels of the given side, m) best.
ShapeFit fitShape(const std::vector<Eigen::Vector2d>& points, double pixel,
                  const std::vector<MarkingShape>& shapes, const ShapeSearch& search);

}  // namespace parkade
