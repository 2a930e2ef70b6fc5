// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/text_patch.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/core/units.hpp"

namespace parkade {
namespace {

using PixelAt = std::function<Eigen::Vector2d(double, double)>;

/// Where the samples of a patch lie in the picture. Patches are small and lenses smooth: pixels are
/// asked for at the nodes of a lattice and taken in straight lines between.
class PatchLattice {
 public:
  PatchLattice(int rows, const PixelAt& pixel_at)
      : rows_(rows), nodes_(rows / kStep + 1, kZonePatchWidth / kStep + 1, CV_64FC2) {
    for (int j = 0; j < nodes_.rows; ++j) {
      for (int i = 0; i < nodes_.cols; ++i) {
        const Eigen::Vector2d pixel =
            pixel_at(i * kStep - 0.5 * kZonePatchWidth, j * kStep - 0.5 * rows);
        nodes_.at<cv::Vec2d>(j, i) = {pixel.x(), pixel.y()};
      }
    }
  }

  // CV_32FC2, `fine` samples along each axis of a pixel of the patch.
  [[nodiscard]] cv::Mat samples(int fine) const {
    cv::Mat map(fine * rows_, fine * kZonePatchWidth, CV_32FC2);
    const int cell = fine * kStep;
    for (int j = 0; j + 1 < nodes_.rows; ++j) {
      for (int i = 0; i + 1 < nodes_.cols; ++i) {
        fill(map(cv::Rect(i * cell, j * cell, cell, cell)), j, i);
      }
    }
    return map;
  }

 private:
  static constexpr int kStep = 4;  // px of the patch

  void fill(cv::Mat cell, int j, int i) const {
    const cv::Vec2d& upper_left = nodes_.at<cv::Vec2d>(j, i);
    const cv::Vec2d& upper_right = nodes_.at<cv::Vec2d>(j, i + 1);
    const cv::Vec2d& lower_left = nodes_.at<cv::Vec2d>(j + 1, i);
    const cv::Vec2d& lower_right = nodes_.at<cv::Vec2d>(j + 1, i + 1);
    const cv::Vec2d none(kNoPixel.x(), kNoPixel.y());
    if (upper_left == none || upper_right == none || lower_left == none || lower_right == none) {
      cell.setTo(cv::Scalar(none[0], none[1]));
      return;
    }
    const double step = 1.0 / cell.rows;
    for (int v = 0; v < cell.rows; ++v) {
      const double down = (v + 0.5) * step;
      const cv::Vec2d left = upper_left + down * (lower_left - upper_left);
      const cv::Vec2d across = step * (upper_right + down * (lower_right - upper_right) - left);
      auto* out = cell.ptr<cv::Vec2f>(v);
      for (int u = 0; u < cell.cols; ++u) out[u] = cv::Vec2f(left + (u + 0.5) * across);
    }
  }

  int rows_;
  cv::Mat nodes_;
};

}  // namespace

cv::Mat sampleTextPatch(const cv::Mat& image, int rows, int fine, const PixelAt& pixel_at) {
  const cv::Mat map = PatchLattice(rows, pixel_at).samples(fine);
  cv::Mat sampled;
  cv::remap(image, sampled, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  sampled.convertTo(sampled, CV_32F);
  if (fine > 1) {
    cv::resize(sampled, sampled, {kZonePatchWidth, rows}, 0, 0, cv::INTER_AREA);
  }
  if (sampled.channels() == 1) cv::cvtColor(sampled, sampled, cv::COLOR_GRAY2BGR);
  return sampled;
}

void normaliseTextPatch(cv::Mat& patch, const cv::Rect& face) {
  constexpr double kMiddle = 128.0;
  constexpr double kSpread = 40.0;
  constexpr double kLeastSpread = 1.5;  // below it there is nothing but rounding
  cv::Scalar mean;
  cv::Scalar spread;
  cv::meanStdDev(patch(face), mean, spread);
  const double sigma = std::sqrt((square(spread[0]) + square(spread[1]) + square(spread[2])) / 3.0);
  const double gain = kSpread / std::max(kLeastSpread, sigma);
  for (int v = 0; v < patch.rows; ++v) {
    auto* row = patch.ptr<cv::Vec3f>(v);
    for (int u = 0; u < patch.cols; ++u) {
      for (int c = 0; c < 3; ++c) {
        row[u][c] = static_cast<float>(kMiddle + gain * (row[u][c] - mean[c]));
      }
    }
  }
  // What lies beside is grey: the pillar's next face bears the same text.
  const int margin = 1 + face.width / 16;
  const int left = std::max(0, face.x - margin);
  const int right = std::min(patch.cols, face.br().x + margin);
  patch.colRange(0, left).setTo(cv::Scalar::all(kMiddle));
  patch.colRange(right, patch.cols).setTo(cv::Scalar::all(kMiddle));
  cv::Mat bytes;
  patch.convertTo(bytes, CV_8UC3);
  patch = bytes;
}

}  // namespace parkade
