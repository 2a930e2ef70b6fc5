// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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
    most_ = std::max(most_, ++counts_[patternOf(text)]);
    ++all_;
  }

  /// Logarithm of how much likelier a text is for its pattern than for that of all markers so far;
  /// 0 where no marker is known. Once most of several markers are alike, what differs from them was
  /// probably misread, as often as it may be.
  [[nodiscard]] double logPrior(const std::string& text) const {
    if (hasScheme()) return isStray(text) ? kStray : 0.0;
    return std::log((countOf(patternOf(text)) + kUnseen) / (all_ + kUnseen));
  }

  /// Whether nearly all markers are called otherwise.
  [[nodiscard]] bool isStray(const std::string& text) const {
    return hasScheme() && countOf(patternOf(text)) < most_;
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
  static constexpr int kSeveral = 6;      ///< markers
  static constexpr double kMost = 0.6;    ///< of them
  static constexpr double kStray = -8.0;

  [[nodiscard]] int countOf(const std::string& pattern) const {
    const auto it = counts_.find(pattern);
    return it == counts_.end() ? 0 : it->second;
  }
  [[nodiscard]] bool hasScheme() const { return all_ >= kSeveral && most_ >= kMost * all_; }

  std::map<std::string, int> counts_;
  int all_ = 0;
  int most_ = 0;  ///< of one pattern
};

}  // namespace parkade
