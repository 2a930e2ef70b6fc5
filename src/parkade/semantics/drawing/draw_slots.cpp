// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/drawing/draw_slots.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace parkade {
namespace {

constexpr int kSubPixel = 4;  // bits of a drawn coordinate

cv::Scalar colourFor(const SlotObservation& slot) {
  const double strength = 0.4 + 0.6 * slot.confidence;
  constexpr double kUnsure = 0.1;
  cv::Scalar colour(0.0, 200.0, 220.0);
  if (slot.probability_free > 0.5 + kUnsure) colour = {60.0, 220.0, 40.0};
  if (slot.probability_free < 0.5 - kUnsure) colour = {50.0, 50.0, 240.0};
  return colour * strength;
}

}  // namespace

cv::Mat drawSlots(const cv::Mat& image, const BevGeometry& geometry,
                  const std::vector<SlotObservation>& slots,
                  const std::vector<LineSegment>& segments, double scale) {
  cv::Mat picture;
  cv::resize(image, picture, {}, scale, scale, cv::INTER_NEAREST);
  const double zoom = static_cast<double>(picture.cols) / geometry.width_px;
  const auto line = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                        const cv::Scalar& colour, int thickness) {
    const auto at = [&](const Eigen::Vector2d& p) {
      const Eigen::Vector2d pixel = (zoom * (geometry.toPixel(p) + Eigen::Vector2d::Constant(0.5)) -
                                     Eigen::Vector2d::Constant(0.5)) *
                                    (1 << kSubPixel);
      return cv::Point(static_cast<int>(std::lround(pixel.x())),
                       static_cast<int>(std::lround(pixel.y())));
    };
    cv::line(picture, at(a), at(b), colour, thickness, cv::LINE_AA, kSubPixel);
  };
  for (const LineSegment& segment : segments) {
    line(segment.begin, segment.end, {255.0, 255.0, 255.0}, 1);
  }
  for (const SlotObservation& slot : slots) {
    const cv::Scalar colour = colourFor(slot);
    const auto& c = slot.corners;
    const double share = slot.rear_seen ? 1.0 : 0.5;
    line(c[0], c[0] + share * (c[3] - c[0]), colour, 1);
    line(c[1], c[1] + share * (c[2] - c[1]), colour, 1);
    if (slot.rear_seen) line(c[2], c[3], colour, 1);
    line(c[0], c[1], colour, 3);
  }
  return picture;
}

}  // namespace parkade
