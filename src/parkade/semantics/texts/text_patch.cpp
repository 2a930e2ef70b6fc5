// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/text_patch.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/core/units.hpp"

namespace parkade {
cv::Mat sampleTextPatch(const cv::Mat& image, int rows, int fine,
                        const std::function<Eigen::Vector2d(double, double)>& pixel_at) {
  const cv::Size size(fine * kZonePatchWidth, fine * rows);
  cv::Mat map(size, CV_32FC2);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const Eigen::Vector2d pixel =
          pixel_at((u + 0.5) / fine - 0.5 * kZonePatchWidth, (v + 0.5) / fine - 0.5 * rows);
      map.at<cv::Vec2f>(v, u) = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
    }
  }
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
