// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/stitched_views.hpp"

#include <algorithm>

namespace parkade {

BevViews viewsOf(const BevStitcher& stitcher, const Rig& rig, const std::vector<bool>& present) {
  constexpr double kLeastHeight = 0.1;  // m
  const BevGeometry& g = stitcher.geometry();
  BevViews views;
  views.view_of = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(255));
  cv::Mat best(g.height_px, g.width_px, CV_32FC1, cv::Scalar(0.0F));
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const Eigen::Vector3d place = rig.cameras[i].T_vehicle_cam.translation();
    views.views.push_back({place.head<2>(), std::max(kLeastHeight, place.z())});
    if (i < present.size() && !present[i]) continue;
    const GroundTable& table = stitcher.table(static_cast<int>(i));
    const cv::Rect& roi = table.roi();
    for (int v = 0; v < roi.height; ++v) {
      const float* weight = table.weight().ptr<float>(v);
      float* so_far = best.ptr<float>(v + roi.y) + roi.x;
      std::uint8_t* view = views.view_of.ptr<std::uint8_t>(v + roi.y) + roi.x;
      for (int u = 0; u < roi.width; ++u) {
        if (weight[u] <= so_far[u]) continue;
        so_far[u] = weight[u];
        view[u] = static_cast<std::uint8_t>(i);
      }
    }
  }
  return views;
}

}  // namespace parkade
