// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/detector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "parkade/core/check.hpp"
#include "parkade/tracking/patch.hpp"

namespace parkade {
namespace {

// A patch and its gradients must fit around a corner.
constexpr int kBorder = Patch::kRadius + 2;
// Tries per cell: the best place may lie too close to a feature of the next cell.
constexpr int kMaxTries = 4;
constexpr TimeNs kNever = std::numeric_limits<TimeNs>::min();

// Standard deviation (grey) of the pixels' noise: from the median second difference along rows,
// which edges, being few, hardly change. Of white noise s that has a deviation of sqrt(6) s, and a
// median of its size of 0.6745 times that.
double noiseOf(const cv::Mat& image) {
  constexpr int kRows = 8;  // one of so many
  std::array<int, 1024> histogram{};
  int count = 0;
  for (int y = kRows / 2; y < image.rows; y += kRows) {
    const std::uint8_t* row = image.ptr<std::uint8_t>(y);
    for (int x = 1; x + 1 < image.cols; ++x) {
      ++histogram[static_cast<std::size_t>(std::abs(row[x - 1] - 2 * row[x] + row[x + 1]))];
      ++count;
    }
  }
  int below = 0;
  std::size_t level = 0;
  while (below + histogram[level] < (count + 1) / 2) below += histogram[level++];
  // Within its step, which rounding spreads from half below to half above.
  const double share = histogram[level] > 0 ? (0.5 * count - below) / histogram[level] : 0.0;
  const double middle = level == 0 ? 0.5 * share : static_cast<double>(level) - 0.5 + share;
  constexpr double kMedian = 1.652;  // 0.6745 sqrt(6)
  return middle / kMedian;
}

}  // namespace

GridDetector::GridDetector(const DetectionOptions& options, int width, int height)
    : options_(options), width_(width), height_(height) {
  PARKADE_CHECK(width > 2 * kBorder && height > 2 * kBorder, "image of {} x {} px", width, height);
  const double side = std::sqrt(static_cast<double>(width) * height / options.features);
  columns_ = std::max(1, static_cast<int>(std::lround(width / side)));
  rows_ = std::max(1, static_cast<int>(std::lround(height / side)));
}

std::vector<Corner> GridDetector::detect(const cv::Mat& image, const cv::Mat& mask,
                                         const std::vector<Eigen::Vector2d>& taken, TimeNs t_ns,
                                         std::vector<TimeNs>* barren) const {
  PARKADE_CHECK(image.type() == CV_8UC1 && image.cols == width_ && image.rows == height_,
                "image {} x {} of type {}", image.cols, image.rows, image.type());
  const int cells = columns_ * rows_;
  if (barren != nullptr) barren->resize(static_cast<std::size_t>(cells), kNever);
  std::vector<std::uint8_t> filled(static_cast<std::size_t>(cells), 0);
  for (const Eigen::Vector2d& pixel : taken) {
    const int column = std::clamp(static_cast<int>(pixel.x() * columns_ / width_), 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>(pixel.y() * rows_ / height_), 0, rows_ - 1);
    filled[static_cast<std::size_t>(row * columns_ + column)] = 1;
  }
  // cornerMinEigenVal gives 4 / 255^2 times the mean squared gradient (Sobel of 3, 8-bit images).
  const auto gradientOf = [](float eigenvalue) {
    return 127.5 * std::sqrt(std::max(eigenvalue, 0.0F));
  };
  const double min_gradient =
      std::max(options_.min_gradient, options_.min_gradient_noise * noiseOf(image));
  std::vector<Eigen::Vector2d> near = taken;
  std::vector<Corner> corners;
  cv::Mat scores;
  const int halo = options_.block_px / 2 + 2;
  for (int cell = 0; cell < cells; ++cell) {
    if (filled[static_cast<std::size_t>(cell)] != 0) continue;
    if (barren != nullptr && (*barren)[static_cast<std::size_t>(cell)] != kNever &&
        toSeconds(t_ns - (*barren)[static_cast<std::size_t>(cell)]) < options_.rest_s) {
      continue;
    }
    const std::size_t found_before = corners.size();
    const int column = cell % columns_;
    const int row = cell / columns_;
    const int x0 = std::max(column * width_ / columns_, kBorder);
    const int y0 = std::max(row * height_ / rows_, kBorder);
    const int x1 = std::min((column + 1) * width_ / columns_, width_ - kBorder);
    const int y1 = std::min((row + 1) * height_ / rows_, height_ - kBorder);
    if (x1 - x0 < 3 || y1 - y0 < 3) continue;
    // The halo makes the scores inside the same as those of the whole image; kBorder covers it.
    const int grow = std::min(halo, kBorder);
    const cv::Rect wide(x0 - grow, y0 - grow, x1 - x0 + 2 * grow, y1 - y0 + 2 * grow);
    cv::cornerMinEigenVal(image(wide), scores, options_.block_px, 3, cv::BORDER_REFLECT_101);
    cv::Mat inner = scores(cv::Rect(grow, grow, x1 - x0, y1 - y0));
    if (!mask.empty()) inner.setTo(0.0F, mask(cv::Rect(x0, y0, x1 - x0, y1 - y0)) == 0);
    for (const Eigen::Vector2d& pixel : near) {
      const cv::Point p(static_cast<int>(std::lround(pixel.x())) - x0,
                        static_cast<int>(std::lround(pixel.y())) - y0);
      const int reach = static_cast<int>(options_.min_distance_px);
      if (p.x < -reach || p.y < -reach || p.x > inner.cols + reach || p.y > inner.rows + reach) {
        continue;
      }
      cv::circle(inner, p, reach, cv::Scalar(0), cv::FILLED);
    }
    for (int attempt = 0; attempt < kMaxTries; ++attempt) {
      double best = 0.0;
      cv::Point place;
      cv::minMaxLoc(inner, nullptr, &best, nullptr, &place);
      const double gradient = gradientOf(static_cast<float>(best));
      if (gradient < min_gradient) break;
      // A maximum at the cell's edge may be the flank of a better corner beyond.
      const cv::Point at(place.x + grow, place.y + grow);
      double around = 0.0;
      cv::minMaxLoc(scores(cv::Rect(at.x - 1, at.y - 1, 3, 3)), nullptr, &around);
      if (around > best) {
        cv::circle(inner, place, 3, cv::Scalar(0), cv::FILLED);
        continue;
      }
      const Eigen::Vector2d pixel(x0 + place.x, y0 + place.y);
      corners.push_back({pixel, gradient});
      near.push_back(pixel);
      break;
    }
    if (barren != nullptr) {
      (*barren)[static_cast<std::size_t>(cell)] = corners.size() == found_before ? t_ns : kNever;
    }
  }
  return corners;
}

}  // namespace parkade
