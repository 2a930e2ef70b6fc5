// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "parkade/semantics/label_probe.hpp"

namespace parkade {

/// Finds where the paint of a slot's line ends: by its labels, on as far as the network holds worn
/// paint for a line nearly as much, and to a fraction of a pixel where the picture has an edge
/// there. grey: CV_8UC1, the picture that the labels are of; both must outlive it. Level frame.
class LineEndFinder {
 public:
  LineEndFinder(const cv::Mat& grey, const LabelProbe& probe) : grey_(grey), probe_(probe) {}

  struct End {
    Eigen::Vector2d p;  ///< where the paint ends, on the line's axis
    double sigma_px;
  };
  /// From a point on the line outwards (unit), at most 1.2 m; width of the line in m. None where
  /// the end is hidden by more than what is narrow (a leg, a pole), or beyond the picture.
  [[nodiscard]] std::optional<End> from(const Eigen::Vector2d& start,
                                        const Eigen::Vector2d& outward, double width) const;

 private:
  [[nodiscard]] bool isFaintPaint(const Eigen::Vector2d& p) const;
  [[nodiscard]] std::optional<double> edge(const Eigen::Vector2d& at,
                                           const Eigen::Vector2d& outward, double width) const;

  const cv::Mat& grey_;
  const LabelProbe& probe_;
};

}  // namespace parkade
