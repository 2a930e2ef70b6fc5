// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/types/semantic_class.hpp"

namespace parkade {

/// Counts how often pixels of one class were labelled as another.
class LabelConfusion {
 public:
  /// Both CV_8UC1 of SemanticClass values and of one size (checked); where mask (CV_8UC1) is 0, or
  /// everywhere if it is empty, pixels do not count.
  void add(const cv::Mat& truth, const cv::Mat& found, const cv::Mat& mask = {});
  void add(const LabelConfusion& other);

  [[nodiscard]] std::int64_t count(SemanticClass truth, SemanticClass found) const;
  [[nodiscard]] std::int64_t truePixels(SemanticClass truth) const;

  /// Intersection over union; NaN where the truth never shows the class.
  [[nodiscard]] double iou(SemanticClass semantic_class) const;
  /// The same with several classes taken as one.
  [[nodiscard]] double iou(const std::vector<SemanticClass>& classes) const;
  /// Mean over those of the classes that occur; NaN where none does.
  [[nodiscard]] double meanIou(const std::vector<SemanticClass>& classes) const;

 private:
  std::array<std::array<std::int64_t, kNumSemanticClasses>, kNumSemanticClasses> counts_{};
};

}  // namespace parkade
