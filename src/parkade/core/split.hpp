// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace parkade {

/// The parts of a list such as "front,rear"; empty ones are left out.
inline std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    if (end > begin) parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// Whether a part of such a list is empty, or all of it: "", ",", "front,,rear", "front,".
inline bool hasEmptyPart(std::string_view text, char separator) {
  const auto parts = std::count(text.begin(), text.end(), separator) + 1;
  return static_cast<std::ptrdiff_t>(split(text, separator).size()) != parts;
}

}  // namespace parkade
