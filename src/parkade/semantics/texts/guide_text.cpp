// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/guide_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <utility>

namespace parkade {
namespace {

constexpr std::array<std::pair<char, const char*>, 3> kArrows = {
    {{'<', "_left"}, {'>', "_right"}, {'^', "_straight"}}};

std::string cased(std::string word, int (*as)(int)) {
  std::transform(word.begin(), word.end(), word.begin(),
                 [as](unsigned char c) { return static_cast<char>(as(c)); });
  return word;
}

}  // namespace

std::string guideMeaning(const std::string& reading) {
  const std::size_t at = reading.find_first_of("<>^");
  if (at == std::string::npos) return reading;
  const bool before = at == 0;
  const std::string word = before ? reading.substr(1) : reading.substr(0, reading.size() - 1);
  if (word.empty() || word.find_first_of("<>^") != std::string::npos) return {};
  const auto* arrow = std::find_if(kArrows.begin(), kArrows.end(),
                                   [&](const auto& a) { return a.first == reading[at]; });
  return (word == "P" ? "parking" : cased(word, std::tolower)) + arrow->second;
}

std::string guideReading(const std::string& meaning) {
  for (const auto& [arrow, ending] : kArrows) {
    const std::size_t at = meaning.rfind(ending);
    if (at == std::string::npos) continue;
    const std::string word =
        meaning.rfind("parking", 0) == 0 ? "P" : cased(meaning.substr(0, at), std::toupper);
    return arrow == '<' ? arrow + word : word + arrow;
  }
  return meaning;
}

}  // namespace parkade
