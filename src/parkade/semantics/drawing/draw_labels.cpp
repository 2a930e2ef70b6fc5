// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/drawing/draw_labels.hpp"

#include <opencv2/imgproc.hpp>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

// Blue, green, red by class value; neighbours on the floor differ most.
constexpr std::array<std::array<std::uint8_t, 3>, kNumSemanticClasses> kColours = {{
    {0, 0, 0},        // unknown
    {90, 90, 90},     // floor
    {255, 255, 255},  // slot_line
    {0, 220, 255},    // lane_line
    {0, 255, 0},      // arrow
    {0, 128, 255},    // speed_limit_paint
    {0, 0, 255},      // stop_line
    {255, 255, 0},    // crossing
    {0, 80, 160},     // speed_bump
    {255, 0, 255},    // painted_number
    {255, 0, 0},      // wheel_stop
    {160, 60, 120},   // pillar
    {90, 120, 160},   // wall
    {60, 60, 60},     // ceiling
    {255, 140, 40},   // vehicle
    {160, 120, 255},  // pedestrian
    {120, 255, 180},  // zone_marker
    {0, 150, 0},      // guide_sign
    {60, 60, 255},    // speed_limit_sign
}};

}  // namespace

std::array<std::uint8_t, 3> colourOf(SemanticClass semantic_class) {
  return kColours[static_cast<std::size_t>(semantic_class)];
}

cv::Mat drawLabels(const cv::Mat& image, const cv::Mat& labels, double share) {
  PARKADE_CHECK(image.depth() == CV_8U && labels.type() == CV_8UC1, "types {} and {}", image.type(),
                labels.type());
  cv::Mat out;
  if (image.channels() == 1) {
    cv::cvtColor(image, out, cv::COLOR_GRAY2BGR);
  } else {
    out = image.clone();
  }
  cv::Mat classes = labels;
  if (labels.size() != image.size()) {
    cv::resize(labels, classes, image.size(), 0, 0, cv::INTER_NEAREST);
  }
  for (int v = 0; v < out.rows; ++v) {
    for (int u = 0; u < out.cols; ++u) {
      const std::uint8_t value = classes.at<std::uint8_t>(v, u);
      if (value <= static_cast<std::uint8_t>(SemanticClass::kFloor) ||
          value >= kNumSemanticClasses) {
        continue;
      }
      auto& pixel = out.at<cv::Vec3b>(v, u);
      for (int c = 0; c < 3; ++c) {
        pixel[c] = static_cast<std::uint8_t>((1.0 - share) * pixel[c] +
                                             share * kColours[value][static_cast<std::size_t>(c)]);
      }
    }
  }
  return out;
}

}  // namespace parkade
