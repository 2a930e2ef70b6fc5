// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core/mat.hpp>

namespace parkade {

/// Where and how a patch was found in an image.
struct PatchAlignment {
  bool converged = false;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Matrix2d warp = Eigen::Matrix2d::Identity();  ///< patch offsets to image offsets
  double correlation = 0.0;  ///< normalised cross correlation with the patch, -1 to 1
  double sigma_px = 0.0;     ///< of the position, from the residual and the patch's gradients
};

/// A feature's look in one picture, and its alignment in others: affine warp, with gain, offset and
/// slope of the brightness projected out (inverse compositional; Baker & Matthews, "Lucas-Kanade 20
/// years on", IJCV 2004, and part 3, project-out). docs/math/tracking.md.
class Patch {
 public:
  static constexpr int kRadius = 7;
  static constexpr int kSize = 2 * kRadius + 1;
  static constexpr int kCount = kSize * kSize;

  /// The patch around a pixel, seen through a warp (identity: as it is); none where it leaves the
  /// image (CV_8UC1) or has no texture.
  static std::shared_ptr<const Patch> sample(const cv::Mat& image, const Eigen::Vector2d& pixel);

  /// Finds the patch near the given start. affine_sigma: how much the shape may differ from the
  /// start's (standard deviation of each entry); image noise is taken from the residual.
  [[nodiscard]] PatchAlignment align(const cv::Mat& image, const Eigen::Vector2d& pixel,
                                     const Eigen::Matrix2d& warp, double affine_sigma,
                                     int max_iterations = 10) const;

 private:
  Eigen::Matrix<float, kCount, 1> values_;   // zero weighted mean
  Eigen::Matrix<float, kCount, 6> descent_;  // weighted, appearance projected out
  Eigen::Matrix<double, 6, 6> hessian_;
  double variance_ = 0.0;  // weighted mean square of values_
};

}  // namespace parkade
