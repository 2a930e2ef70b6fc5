// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace parkade {

/// A text with the probability that a reader gives it.
struct TextReading {
  std::string text;
  double probability = 0.0;
};

/// Probability of the best text of some readings, best first; 0 where nothing may be written.
inline double certaintyOf(const std::vector<TextReading>& readings) {
  for (const TextReading& reading : readings) {
    if (!reading.text.empty()) return reading.probability;
  }
  return 0.0;
}

}  // namespace parkade
