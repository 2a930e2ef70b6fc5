// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "parkade/semantics/sequence_decoding.hpp"

namespace parkade {

/// Which text several readings of one marker agree on: logarithms of its likelihood ratio to a
/// text that no reading knows, added up. A reading may be wrong altogether (a part was hidden, two
/// faces ran together), so that a text which one of them does not list loses only so much.
class TextEvidence {
 public:
  /// The readings of one face, best first. A face that is probably plain says nothing of the
  /// marker.
  void add(const std::vector<TextReading>& readings) {
    constexpr double kWrong = 0.05;    // share of readings that are wrong altogether
    constexpr double kAnyText = 0.02;  // what such a reading gives to any one text
    double none = kWrong * kAnyText;
    for (const TextReading& reading : readings) {
      if (reading.text.empty()) none += reading.probability;
    }
    for (const TextReading& reading : readings) {
      if (reading.text.empty()) continue;
      evidence_[reading.text] += std::log1p((1.0 - kWrong) * reading.probability / none);
    }
  }

  /// The best text and its probability; empty and 0 where nothing was read.
  [[nodiscard]] TextReading best() const {
    constexpr double kNone = 2.0;  // of all texts that no reading knows
    TextReading result;
    double most = 0.0;
    for (const auto& [text, value] : evidence_) {
      if (value <= most) continue;
      most = value;
      result.text = text;
    }
    if (result.text.empty()) return result;
    double sum = std::exp(kNone - most);
    for (const auto& [text, value] : evidence_) sum += std::exp(value - most);
    result.probability = 1.0 / sum;
    return result;
  }

 private:
  std::map<std::string, double> evidence_;
};

}  // namespace parkade
