// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/zone_marker_patch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace parkade {
namespace {

double square(double value) {
  return value * value;
}

// Brings a face to one brightness and contrast whatever its light, by what lies inside `face`.
void normalise(cv::Mat& patch, const cv::Rect& face) {
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

/// A place on a face and how it lies in the patch.
struct PatchPlane {
  Eigen::Vector3d center = Eigen::Vector3d::UnitZ();  ///< right, up, depth
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();
  double scale = 1.0;  ///< px of the patch per unit
};

// CV_32F, of the patch's size.
cv::Mat sampleFace(const cv::Mat& image, const LevelView& view, const PatchPlane& plane,
                   double height_px) {
  // Near faces are sampled more finely than the patch, then averaged.
  const int fine = std::clamp(static_cast<int>(std::ceil(height_px / plane.scale)), 1, 4);
  const cv::Size size(fine * kZonePatchWidth, fine * kZonePatchHeight);
  cv::Mat map(size, CV_32FC2);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const double right_of = ((u + 0.5) / fine - 0.5 * kZonePatchWidth) / plane.scale;
      const double over = (0.5 * kZonePatchHeight - (v + 0.5) / fine) / plane.scale;
      const Eigen::Vector3d p =
          plane.center + right_of * plane.along + over * Eigen::Vector3d::UnitY();
      Eigen::Vector2d pixel(-10.0, -10.0);
      if (p.z() < 0.1 * plane.center.z() || !view.project(p, pixel)) pixel << -10.0, -10.0;
      map.at<cv::Vec2f>(v, u) = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
    }
  }
  cv::Mat sampled;
  cv::remap(image, sampled, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  sampled.convertTo(sampled, CV_32F);
  if (fine > 1) {
    cv::resize(sampled, sampled, {kZonePatchWidth, kZonePatchHeight}, 0, 0, cv::INTER_AREA);
  }
  return sampled;
}

}  // namespace

ZoneMarkerFace straighten(const cv::Mat& image, const LevelView& view, const FittedFace& face,
                          double middle) {
  const Eigen::Vector3d left(face.x_left * face.depth_left, middle, face.depth_left);
  const Eigen::Vector3d right(face.x_right * face.depth_right, middle, face.depth_right);
  const Eigen::Vector3d along = (right - left).normalized();
  const Eigen::Vector3d center = 0.5 * (left + right);
  ZoneMarkerFace result;
  result.slant = face.slant();
  Eigen::Vector2d below;
  Eigen::Vector2d above;
  if (!view.project(center - 0.5 * Eigen::Vector3d::UnitY(), below) ||
      !view.project(center + 0.5 * Eigen::Vector3d::UnitY(), above)) {
    return result;
  }
  result.height_px = (above - below).norm();
  const Eigen::Vector3d half_up = 0.5 * Eigen::Vector3d::UnitY();
  const std::array<Eigen::Vector3d, 4> ends = {left + half_up, right + half_up, right - half_up,
                                               left - half_up};
  for (std::size_t k = 0; k < 4; ++k) {
    if (!view.project(ends[k], result.corners[k])) return result;
  }
  constexpr double kRows = 34.0;  // of the face
  constexpr double kColumns = 80.0;
  const double scale = std::min(kRows, kColumns / std::max(1e-3, face.width()));
  cv::Mat sampled = sampleFace(image, view, {center, along, scale}, result.height_px);
  if (sampled.channels() == 1) cv::cvtColor(sampled, sampled, cv::COLOR_GRAY2BGR);
  const int half_width = std::clamp(static_cast<int>(0.5 * scale * face.width()), 4, 48);
  const int half_height = std::clamp(static_cast<int>(0.5 * scale), 4, 20);
  normalise(sampled, {kZonePatchWidth / 2 - half_width, kZonePatchHeight / 2 - half_height,
                      2 * half_width, 2 * half_height});
  result.patch = sampled;
  return result;
}

}  // namespace parkade
