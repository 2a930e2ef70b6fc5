// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "parkade/types/text_reading.hpp"

namespace parkade {

/// Limits that garages have, painted or on signs; with spaces between, as options hold them.
inline constexpr const char* kUsualLimits = "5 8 10 15 20 25 30 40 50";

/// Drops readings of anything else.
inline void keepTexts(const std::vector<std::string>& known, std::vector<TextReading>& readings) {
  std::erase_if(readings, [&](const TextReading& reading) {
    return std::find(known.begin(), known.end(), reading.text) == known.end();
  });
}

}  // namespace parkade
