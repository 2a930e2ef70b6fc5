// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/contrast.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

constexpr double kFollow = 0.1;     // share of the way that the curve goes to its target per frame
constexpr double kMiddle = 0.4;     // where the median of a dark image is brought, of 1
constexpr double kMinGamma = 0.4;   // bends no further: noise in the dark would dominate
constexpr double kMinStretch = 24;  // grey levels; less contrast than this is not stretched to full

}  // namespace

GreyLevels measureLevels(const cv::Mat& grey) {
  PARKADE_CHECK(grey.type() == CV_8UC1, "image of type {}", grey.type());
  std::array<int, 256> histogram{};
  int count = 0;
  for (int y = 0; y < grey.rows; y += 2) {
    const std::uint8_t* row = grey.ptr<std::uint8_t>(y);
    for (int x = 0; x < grey.cols; x += 2) ++histogram[row[x]];
    count += (grey.cols + 1) / 2;
  }
  const auto level = [&](double share) {
    int below = 0;
    for (int g = 0; g < 256; ++g) {
      below += histogram[static_cast<std::size_t>(g)];
      if (below > share * count) return g;
    }
    return 255;
  };
  return {level(0.01), level(0.5), level(0.99)};
}

void ContrastNormaliser::updateCurve(const GreyLevels& levels) {
  double black = 0.0;
  double white = 255.0;
  double gamma = 1.0;
  if (levels.p99 - levels.p01 < options_.min_range || levels.p50 < options_.dark_level) {
    black = std::max(0.0, levels.p01 - 2.0);
    white = std::max(levels.p99 + 2.0, black + kMinStretch);
    const double median = std::clamp((levels.p50 - black) / (white - black), 0.01, 0.99);
    gamma = std::clamp(std::log(kMiddle) / std::log(median), kMinGamma, 1.0);
  }
  const double follow = has_curve_ ? kFollow : 1.0;
  black_ += follow * (black - black_);
  white_ += follow * (white - white_);
  gamma_ += follow * (gamma - gamma_);
  has_curve_ = true;
}

bool ContrastNormaliser::apply(const cv::Mat& image, cv::Mat& out) {
  PARKADE_CHECK(image.type() == CV_8UC1 || image.type() == CV_8UC3, "image of type {}",
                image.type());
  cv::Mat grey = image;
  if (image.channels() == 3) {
    grey = cv::Mat();
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  }
  const GreyLevels levels = measureLevels(grey);
  if (levels.p99 - levels.p01 < options_.blind_range) {
    has_curve_ = false;
    black_ = 0.0;
    white_ = 255.0;
    gamma_ = 1.0;
    return false;
  }
  if (options_.mode == "clahe") {
    const cv::Ptr<cv::CLAHE> clahe = cv::createCLAHE(3.0, cv::Size(8, 8));
    cv::Mat equalised;
    clahe->apply(grey, equalised);
    out = equalised;
    return true;
  }
  out = grey;
  if (options_.mode == "off") return true;
  updateCurve(levels);
  if (black_ < 0.5 && white_ > 254.5 && gamma_ > 0.99) return true;
  cv::Mat curve(1, 256, CV_8UC1);
  for (int g = 0; g < 256; ++g) {
    const double x = std::clamp((g - black_) / (white_ - black_), 0.0, 1.0);
    curve.at<std::uint8_t>(0, g) =
        static_cast<std::uint8_t>(std::lround(255.0 * std::pow(x, gamma_)));
  }
  cv::Mat bright;
  cv::LUT(grey, curve, bright);
  out = bright;
  return true;
}

}  // namespace parkade
