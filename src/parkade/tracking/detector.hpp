// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/core/time.hpp"
#include "parkade/tracking/options.hpp"

namespace parkade {

/// A corner found in an image.
struct Corner {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< a whole pixel, see docs/math/tracking.md
  double gradient = 0.0;                            ///< grey/px, rms in the weakest direction
};

/// Finds corners (Shi & Tomasi, "Good features to track", CVPR 1994) spread over an image: one per
/// grid cell that holds no feature yet.
class GridDetector {
 public:
  GridDetector(const DetectionOptions& options, int width, int height);

  /// image: CV_8UC1; mask: CV_8UC1, 0 where no corner may lie, or empty; taken: features that are
  /// already there. Corners come cell by cell, row after row. barren: nothing, or when each cell
  /// was last found to have no corner: kept between the pictures of a camera, empty before the
  /// first. Such a cell is left alone for `rest_s`, since the next picture looks alike.
  [[nodiscard]] std::vector<Corner> detect(const cv::Mat& image, const cv::Mat& mask,
                                           const std::vector<Eigen::Vector2d>& taken,
                                           TimeNs t_ns = 0,
                                           std::vector<TimeNs>* barren = nullptr) const;

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }

 private:
  DetectionOptions options_;
  int width_;
  int height_;
  int columns_;
  int rows_;
};

}  // namespace parkade
