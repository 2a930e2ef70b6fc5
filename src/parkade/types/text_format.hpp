// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <map>
#include <string>

namespace parkade {

/// How the markers of one garage are called: a letter and a number, or a number and a letter, with
/// a dash or not. Who has read some of them knows what the others look like.
/// docs/math/zone_markers.md, equation (4b).
class TextFormat {
 public:
  /// A marker's text that is sure; each marker once.
  void add(const std::string& text) {
    ++counts_[patternOf(text)];
    ++all_;
  }

  /// Logarithm of how much likelier a text is for its pattern than for that of all markers so far;
  /// 0 where no marker is known.
  [[nodiscard]] double logPrior(const std::string& text) const {
    const auto it = counts_.find(patternOf(text));
    const int same = it == counts_.end() ? 0 : it->second;
    return std::log((same + kUnseen) / (all_ + kUnseen));
  }

  /// "A0" of "B12", "0A" of "7K", "A-0" of "C-3": runs of digits count once.
  [[nodiscard]] static std::string patternOf(const std::string& text) {
    std::string pattern;
    for (const char c : text) {
      const bool digit = c >= '0' && c <= '9';
      const char kind = digit ? '0' : c >= 'A' && c <= 'Z' ? 'A' : c;
      if (!digit || pattern.empty() || pattern.back() != '0') pattern += kind;
    }
    return pattern;
  }

 private:
  static constexpr double kUnseen = 0.1;  ///< markers: weight of a pattern that none has
  std::map<std::string, int> counts_;
  int all_ = 0;
};

}  // namespace parkade
