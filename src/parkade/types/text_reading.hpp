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

/// The best of some readings, best first, that is a text; without one, none of probability 0.
inline TextReading bestTextOf(const std::vector<TextReading>& readings) {
  for (const TextReading& reading : readings) {
    if (!reading.text.empty()) return reading;
  }
  return {};
}

/// Its probability; 0 where nothing may be written.
inline double certaintyOf(const std::vector<TextReading>& readings) {
  return bestTextOf(readings).probability;
}

}  // namespace parkade
