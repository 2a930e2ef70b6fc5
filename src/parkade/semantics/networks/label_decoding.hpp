// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/types/semantic_class.hpp"

namespace parkade {

/// What logits say of every pixel; all CV_8UC1.
struct DecodedLabels {
  cv::Mat labels;      ///< the likeliest class
  cv::Mat confidence;  ///< its probability (softmax over the channels, 255 = 1)
  cv::Mat slot_line;   ///< as BevLabels'; empty where no channel means slot lines
  cv::Mat paint;       ///< the same of any paint
};

/// logits: CV_32F, 1 x K x h x w with a channel per class, resized bilinearly to size; or
/// 1 x 4K x size/2 with four channels per class, one for each pixel of a 2 x 2 block, row by row.
/// Several channels may mean one class; the probability is that of the best channel. no_unknown:
/// channels that mean kUnknown are left out.
DecodedLabels decodeLogits(const cv::Mat& logits, const std::vector<SemanticClass>& classes,
                           const cv::Size& size, bool no_unknown = false);

}  // namespace parkade
