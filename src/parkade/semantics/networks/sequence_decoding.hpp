// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "parkade/types/text_reading.hpp"

namespace parkade {

/// The most probable texts of a sequence network's logits (connectionist temporal classification,
/// Graves et al. 2006), best first, each with its whole probability over all alignments that a beam
/// of `beam` prefixes holds. logits: CV_32F, one row per channel (row 0: blank, then the letters of
/// `alphabet`), one column per step. The empty text is one of them.
std::vector<TextReading> decodeSequence(const cv::Mat& logits, const std::string& alphabet,
                                        int beam, int count);

}  // namespace parkade
