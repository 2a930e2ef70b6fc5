// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/types/bev_image.hpp"

namespace parkade {

/// From where each pixel of a bird's-eye picture is seen. What stands upright is smeared away from
/// there, so only its near edge lies on the ground; and it tells how far an error of the attitude
/// moves a pixel.
struct BevViews {
  struct View {
    Eigen::Vector2d foot = Eigen::Vector2d::Zero();  ///< ground point under a camera, level frame
    double height = 1.0;                             ///< m, of the camera over the ground
  };
  std::vector<View> views;
  cv::Mat view_of;  ///< CV_8UC1 of the picture's size: index into views; 255 where nothing is seen

  /// One view from above the picture's middle: what is left where the cameras are not known.
  static BevViews fromMiddle(const BevGeometry& geometry, double height = 1.0) {
    return {{{geometry.center, height}},
            cv::Mat(geometry.height_px, geometry.width_px, CV_8UC1, cv::Scalar(0))};
  }

  /// Which view shows a ground point; views.size() where none does.
  [[nodiscard]] std::size_t indexAt(const BevGeometry& geometry, const Eigen::Vector2d& p) const {
    const Eigen::Vector2d pixel = geometry.toPixel(p);
    const int u = static_cast<int>(pixel.x() + 0.5);
    const int v = static_cast<int>(pixel.y() + 0.5);
    if (u < 0 || v < 0 || u >= view_of.cols || v >= view_of.rows) return views.size();
    return std::min<std::size_t>(view_of.at<unsigned char>(v, u), views.size());
  }

  /// The view of a ground point; the nearest one where no camera sees it.
  [[nodiscard]] const View& viewAt(const BevGeometry& geometry, const Eigen::Vector2d& p) const {
    const std::size_t index = indexAt(geometry, p);
    if (index < views.size()) return views[index];
    std::size_t best = 0;
    for (std::size_t i = 1; i < views.size(); ++i) {
      if ((views[i].foot - p).norm() < (views[best].foot - p).norm()) best = i;
    }
    return views[best];
  }
};

}  // namespace parkade
