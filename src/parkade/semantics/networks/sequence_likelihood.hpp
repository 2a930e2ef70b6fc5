// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "parkade/types/text_reading.hpp"

namespace parkade {

/// In a pattern: any one capital, any one digit.
inline constexpr char kAnyCapital = '\x01';
inline constexpr char kAnyDigit = '\x02';

/// What a sequence network says of a picture: how probable any text is, over all its alignments
/// (connectionist temporal classification, Graves et al. 2006).
class SequenceLikelihood {
 public:
  /// logits: CV_32F, one row per channel (row 0: blank, then the letters of `alphabet`; checked),
  /// one column per step.
  SequenceLikelihood(const cv::Mat& logits, std::string alphabet);

  /// The probability that the first m characters of a pattern are the whole text, for m from 0 to
  /// its length (Graves et al. 2006, eqs. 5 to 8). Characters that the alphabet lacks have none.
  [[nodiscard]] std::vector<double> ofPrefixes(const std::string& pattern) const;

  /// The most probable texts, best first, each with what a beam of `beam` prefixes holds of its
  /// probability; at most `count`. The empty text is one of them.
  [[nodiscard]] std::vector<TextReading> best(int beam, int count) const;

 private:
  [[nodiscard]] int channelOf(char c) const;  // -1: none

  std::string alphabet_;
  cv::Mat p_;  ///< CV_64F, a row per step: blank, letters, any capital, any digit
};

}  // namespace parkade
