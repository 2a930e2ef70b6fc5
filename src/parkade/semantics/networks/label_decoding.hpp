// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/types/semantic_class.hpp"

namespace parkade {

/// The likeliest class of every pixel, and its probability (softmax over the channels, 255 = 1).
/// logits is CV_32F, 1 x K x h x w with a channel per class, resized bilinearly to size; or
/// 1 x 4K x size/2 with four channels per class, one for each pixel of a 2 x 2 block, row by row.
/// Several channels may mean one class; the probability is that of the best channel.
/// slot_line: as BevLabels'; empty where no channel means slot lines. no_unknown: channels that
/// mean kUnknown are left out.
void decodeLogits(const cv::Mat& logits, const std::vector<SemanticClass>& classes,
                  const cv::Size& size, cv::Mat& labels, cv::Mat& confidence, cv::Mat& slot_line,
                  bool no_unknown = false);

}  // namespace parkade
