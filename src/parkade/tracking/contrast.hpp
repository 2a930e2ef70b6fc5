// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "parkade/tracking/options.hpp"

namespace parkade {

/// Grey levels of an image that a share of its pixels lies below.
struct GreyLevels {
  int p01 = 0;
  int p50 = 0;
  int p99 = 0;
};

/// Levels of a CV_8UC1 image, from every second pixel of every second row.
GreyLevels measureLevels(const cv::Mat& grey);

/// Prepares one camera's images: grey, and brightened by a tone curve where they are dark or flat.
/// The curve stretches the 1 % to 99 % levels and bends them (exponent 0.4 to 1) so that the median
/// comes near the middle; it follows the scene slowly, so that a patch looks alike in neighbouring
/// frames.
class ContrastNormaliser {
 public:
  explicit ContrastNormaliser(const ContrastOptions& options) : options_(options) {}

  /// False where the camera sees nothing (black, or one grey all over). image: CV_8UC1 or CV_8UC3.
  /// out may share memory with image where nothing had to be changed.
  bool apply(const cv::Mat& image, cv::Mat& out);

 private:
  void updateCurve(const GreyLevels& levels);

  ContrastOptions options_;
  bool has_curve_ = false;
  double black_ = 0.0;    // grey level that becomes 0
  double white_ = 255.0;  // grey level that becomes 255
  double gamma_ = 1.0;
};

}  // namespace parkade
