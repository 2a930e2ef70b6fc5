// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/markings/painted_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "parkade/core/median.hpp"
#include "parkade/geometry/planar.hpp"
#include "parkade/semantics/texts/text_patch.hpp"

namespace parkade {
namespace {

constexpr auto kNumber = static_cast<std::uint8_t>(SemanticClass::kPaintedNumber);

/// Takes the extents of the labelled pixels within the object's outline; false where there are
/// none.
bool measure(const BevLabels& labels, const std::vector<Eigen::Vector2d>& outline,
             PaintedNumber& number) {
  const BevGeometry& g = labels.geometry;
  Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector2d most = -least;
  Eigen::Vector2d low = least;  // of the outline, px
  Eigen::Vector2d high = most;
  for (const Eigen::Vector2d& p : outline) {
    low = low.cwiseMin(g.toPixel(p));
    high = high.cwiseMax(g.toPixel(p));
  }
  const int u0 = std::max(0, static_cast<int>(std::floor(low.x())));
  const int v0 = std::max(0, static_cast<int>(std::floor(low.y())));
  const int u1 = std::min(labels.labels.cols - 1, static_cast<int>(std::ceil(high.x())));
  const int v1 = std::min(labels.labels.rows - 1, static_cast<int>(std::ceil(high.y())));
  const Eigen::Vector2d up = number.up();
  for (int v = v0; v <= v1; ++v) {
    for (int u = u0; u <= u1; ++u) {
      if (labels.labels.at<std::uint8_t>(v, u) != kNumber) continue;
      const Eigen::Vector2d p = g.toGround({static_cast<double>(u), static_cast<double>(v)});
      const Eigen::Vector2d at(number.right.dot(p), up.dot(p));
      least = least.cwiseMin(at);
      most = most.cwiseMax(at);
    }
  }
  if (least.x() > most.x()) return false;
  const Eigen::Vector2d middle = 0.5 * (least + most);
  number.center = middle.x() * number.right + middle.y() * up;
  number.width = most.x() - least.x() + g.metres_per_px;
  number.height = most.y() - least.y() + g.metres_per_px;
  return true;
}

std::optional<std::size_t> slotAround(const std::vector<SlotObservation>& slots,
                                      const Eigen::Vector2d& p) {
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (contains(slots[i].corners, p)) return i;
  }
  return std::nullopt;
}

Eigen::Vector3d onGround(const Eigen::Vector2d& p) {
  return {p.x(), p.y(), 0.0};
}

}  // namespace

std::vector<PaintedNumber> findPaintedNumbers(const SemanticFrame& frame,
                                              const PaintedNumberOptions& options) {
  std::vector<PaintedNumber> numbers;
  for (std::size_t i = 0; i < frame.objects.size(); ++i) {
    const ObjectObservation& object = frame.objects[i];
    if (object.semantic_class != SemanticClass::kPaintedNumber || object.outline.empty()) continue;
    const auto slot = slotAround(frame.slots, object.position.head<2>());
    if (!slot) continue;
    const SlotObservation& around = frame.slots[*slot];
    PaintedNumber number;
    number.object = i;
    number.slot = slot;
    number.right = (around.corners[1] - around.corners[0]).normalized();
    if (!measure(frame.labels, object.outline, number)) continue;
    if (number.height < options.min_height_m || number.height > options.max_height_m) continue;
    numbers.push_back(number);
  }
  return numbers;
}

std::optional<PaintedNumber> findPaintedLimit(const SemanticFrame& frame, std::size_t object,
                                              const Eigen::Vector2d& up) {
  const ObjectObservation& limit = frame.objects.at(object);
  if (limit.semantic_class != SemanticClass::kSpeedLimitPaint || limit.outline.empty()) {
    return std::nullopt;
  }
  PaintedNumber number;
  number.object = object;
  number.center = limit.position.head<2>();
  number.right = {up.y(), -up.x()};
  // Figures are about half as high as the ring and reach nearly as far as its inner edge.
  const double ring = (limit.outline.front() - number.center).norm();
  number.radius = 0.75 * ring;
  number.width = 1.1 * ring;
  number.height = 0.95 * ring;
  return number;
}

double seenHeight(const PaintedNumber& number, const Camera& camera, const cv::Mat& mask,
                  const SE3& T_level_cam) {
  const SE3 T_cam_level = T_level_cam.inverse();
  const Eigen::Vector2d x = 0.5 * number.width * number.right;
  const Eigen::Vector2d y = 0.5 * number.height * number.up();
  std::array<Eigen::Vector2d, 4> corners;
  const std::array<Eigen::Vector2d, 4> ground = {number.center - x - y, number.center + x - y,
                                                 number.center + x + y, number.center - x + y};
  constexpr double kBorder = 2.0;  // px
  for (std::size_t k = 0; k < 4; ++k) {
    if (!camera.project(T_cam_level * onGround(ground[k]), corners[k]) ||
        !camera.inImage(corners[k], kBorder)) {
      return 0.0;
    }
    const int u = static_cast<int>(std::lround(corners[k].x()));
    const int v = static_cast<int>(std::lround(corners[k].y()));
    if (!mask.empty() && mask.at<std::uint8_t>(v, u) == 0) return 0.0;
  }
  const double across = (corners[1] + corners[2] - corners[0] - corners[3]).norm() / 2.0;
  const double along = (corners[2] + corners[3] - corners[0] - corners[1]).norm() / 2.0;
  return std::min(along, across / number.width * number.height);
}

namespace {

// Gives what lies farther from the middle (px) the colour of the floor just within.
void clearBeyond(double radius, cv::Mat& patch) {
  const auto distance = [&](int u, int v) {
    return std::hypot(u - 0.5 * patch.cols, v - 0.5 * patch.rows);
  };
  std::array<std::vector<float>, 3> rim;
  for (int v = 0; v < patch.rows; ++v) {
    for (int u = 0; u < patch.cols; ++u) {
      if (std::abs(distance(u, v) - radius) > 1.0) continue;
      for (int k = 0; k < 3; ++k)
        rim[static_cast<std::size_t>(k)].push_back(patch.at<cv::Vec3f>(v, u)[k]);
    }
  }
  if (rim[0].empty()) return;
  cv::Vec3f floor;
  for (int k = 0; k < 3; ++k) floor[k] = median(std::move(rim[static_cast<std::size_t>(k)]));
  for (int v = 0; v < patch.rows; ++v) {
    for (int u = 0; u < patch.cols; ++u) {
      if (distance(u, v) > radius) patch.at<cv::Vec3f>(v, u) = floor;
    }
  }
}

}  // namespace

cv::Mat straightenNumber(const PaintedNumber& number, const cv::Mat& image, const Camera& camera,
                         const SE3& T_level_cam) {
  // Letters take about half of a zone marker's face, which the reader has learnt from.
  constexpr double kLetters = 0.52;
  constexpr double kRows = 34.0;  // of the face, px of the patch
  constexpr double kColumns = 80.0;
  const double height = number.height / kLetters;
  const double width = number.width + height - number.height;
  const double scale = std::min(kRows / height, kColumns / width);
  const SE3 T_cam_level = T_level_cam.inverse();
  const double seen = seenHeight(number, camera, {}, T_level_cam);
  const int fine = std::clamp(static_cast<int>(std::ceil(seen / (number.height * scale))), 1, 3);
  const Eigen::Vector2d up = number.up();
  cv::Mat patch = sampleTextPatch(image, kZonePatchHeight, fine, [&](double u, double v) {
    const Eigen::Vector2d p = number.center + u / scale * number.right - v / scale * up;
    Eigen::Vector2d pixel;
    return camera.project(T_cam_level * onGround(p), pixel) ? pixel : kNoPixel;
  });
  if (number.radius > 0.0) clearBeyond(number.radius * scale, patch);
  const int half_width = std::clamp(static_cast<int>(0.5 * scale * width), 4, 48);
  const int half_height = std::clamp(static_cast<int>(0.5 * scale * height), 4, 20);
  normaliseTextPatch(patch, {kZonePatchWidth / 2 - half_width, kZonePatchHeight / 2 - half_height,
                             2 * half_width, 2 * half_height});
  return patch;
}

}  // namespace parkade
