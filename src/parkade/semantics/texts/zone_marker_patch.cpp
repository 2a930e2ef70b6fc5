// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_marker_patch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "parkade/semantics/texts/text_patch.hpp"

namespace parkade {
namespace {

/// A place on a face and how it lies in the patch.
struct PatchPlane {
  Eigen::Vector3d center = Eigen::Vector3d::UnitZ();  ///< right, up, depth
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();
  double scale = 1.0;  ///< px of the patch per unit
};

// CV_32F, of the tall patch's size.
cv::Mat sampleFace(const cv::Mat& image, const LevelCamera& view, const PatchPlane& plane,
                   double height_px) {
  // Near faces are sampled more finely than the patch, then averaged.
  const int fine = std::clamp(static_cast<int>(std::ceil(height_px / plane.scale)), 1, 4);
  return sampleTextPatch(image, kTallPatchHeight, fine, [&](double u, double v) {
    const Eigen::Vector3d p =
        plane.center + u / plane.scale * plane.along - v / plane.scale * Eigen::Vector3d::UnitY();
    Eigen::Vector2d pixel;
    if (p.z() < 0.1 * plane.center.z() || !view.project(p, pixel)) return kNoPixel;
    return pixel;
  });
}

}  // namespace

ZoneMarkerFace straighten(const cv::Mat& image, const LevelCamera& view, const FittedFace& face,
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
  const int half_width = std::clamp(static_cast<int>(0.5 * scale * face.width()), 4, 48);
  const int half_height = std::clamp(static_cast<int>(0.5 * scale), 4, 20);
  normaliseTextPatch(sampled, {kZonePatchWidth / 2 - half_width, kTallPatchHeight / 2 - half_height,
                               2 * half_width, 2 * half_height});
  result.around = sampled;
  result.patch_height = scale;
  const int first = (kTallPatchHeight - kZonePatchHeight) / 2;
  result.patch = sampled.rowRange(first, first + kZonePatchHeight);
  return result;
}

}  // namespace parkade
