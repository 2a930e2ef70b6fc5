// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/overlap.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

constexpr int kSamples = 16;  // per axis of an image
constexpr std::array<double, 6> kDepths = {1.0, 2.0, 4.0, 8.0, 20.0, 1000.0};
constexpr int kMaskStep = 4;  // px, the validity mask's resolution

double overlapOf(const RigCamera& a, const RigCamera& b) {
  const SE3 T_b_a = b.T_vehicle_cam.inverse() * a.T_vehicle_cam;
  int seen = 0;
  int count = 0;
  for (int iy = 0; iy < kSamples; ++iy) {
    for (int ix = 0; ix < kSamples; ++ix) {
      const Eigen::Vector2d pixel((ix + 0.5) * a.camera.width() / kSamples - 0.5,
                                  (iy + 0.5) * a.camera.height() / kSamples - 0.5);
      Eigen::Vector3d ray;
      if (!a.camera.unproject(pixel, ray)) continue;
      ++count;
      seen += std::any_of(kDepths.begin(), kDepths.end(), [&](double depth) {
        Eigen::Vector2d other;
        return b.camera.project(T_b_a * (depth * ray), other) && b.camera.inImage(other);
      });
    }
  }
  return count > 0 ? static_cast<double>(seen) / count : 0.0;
}

}  // namespace

std::vector<std::vector<double>> computeOverlap(const Rig& rig) {
  const std::size_t n = rig.cameras.size();
  std::vector<std::vector<double>> overlap(n, std::vector<double>(n, 0.0));
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      if (a != b) overlap[a][b] = overlapOf(rig.cameras[a], rig.cameras[b]);
    }
  }
  return overlap;
}

cv::Mat validityMask(const Camera& camera) {
  cv::Mat mask(camera.height(), camera.width(), CV_8UC1, cv::Scalar(255));
  for (int y = 0; y < camera.height(); y += kMaskStep) {
    for (int x = 0; x < camera.width(); x += kMaskStep) {
      const Eigen::Vector2d pixel(x + 0.5 * (kMaskStep - 1), y + 0.5 * (kMaskStep - 1));
      Eigen::Vector3d ray;
      Eigen::Vector2d again;
      // A model may give a ray beyond the angle from which its distortion folds back.
      if (camera.unproject(pixel, ray) && camera.project(ray, again) &&
          (again - pixel).norm() < 0.5) {
        continue;
      }
      const cv::Rect cell =
          cv::Rect(x, y, kMaskStep, kMaskStep) & cv::Rect(0, 0, mask.cols, mask.rows);
      mask(cell).setTo(0);
    }
  }
  return mask;
}

Result<std::vector<cv::Mat>> readBodyMasks(const Rig& rig) {
  std::vector<cv::Mat> masks(rig.cameras.size());
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const RigCamera& camera = rig.cameras[c];
    if (!camera.mask_pixels.empty()) {
      const int width = camera.camera.width();
      const int height = camera.camera.height();
      PARKADE_CHECK(camera.mask_pixels.size() ==
                        static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                    "mask of {} has {} pixels for {} x {}", camera.name, camera.mask_pixels.size(),
                    width, height);
      masks[c].create(height, width, CV_8UC1);
      std::copy(camera.mask_pixels.begin(), camera.mask_pixels.end(), masks[c].data);
      continue;
    }
    if (camera.mask_path.empty()) continue;
    // OpenCV would print about a file that is not there.
    if (std::filesystem::exists(camera.mask_path)) {
      masks[c] = cv::imread(camera.mask_path, cv::IMREAD_GRAYSCALE);
    }
    if (masks[c].empty()) {
      return Error{
          fmt::format("{}: cannot read the mask of {}; give an 8-bit picture or remove "
                      "the entry from the rig",
                      camera.mask_path, camera.name)};
    }
    if (masks[c].cols != camera.camera.width() || masks[c].rows != camera.camera.height()) {
      return Error{fmt::format("{}: mask of {} is {} x {} px, its images are {} x {}",
                               camera.mask_path, camera.name, masks[c].cols, masks[c].rows,
                               camera.camera.width(), camera.camera.height())};
    }
  }
  return masks;
}

}  // namespace parkade
