// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_text_share.hpp"

#include <algorithm>
#include <vector>

namespace parkade {
namespace {

constexpr double kBeside = 0.9;    // once, and a part of it beside
constexpr double kMisread = 0.3;   // the same, whatever letters are read there
constexpr double kTwoParts = 0.3;  // an end of it and a beginning, together as long as it
constexpr double kPart = 0.1;      // less than that

// What its letters are; others stand for themselves.
std::string patternOf(const std::string& text) {
  std::string pattern = text;
  for (char& c : pattern) {
    if (c >= 'A' && c <= 'Z') c = kAnyCapital;
    if (c >= '0' && c <= '9') c = kAnyDigit;
  }
  return pattern;
}

bool isMixed(const std::string& pattern) {
  return pattern.find(kAnyCapital) != std::string::npos &&
         pattern.find(kAnyDigit) != std::string::npos;
}

// Patches that begin with the whole text.
double beginning(const std::string& text, const SequenceLikelihood& patch) {
  const std::size_t n = text.size();
  const std::vector<double> p = patch.ofPrefixes(text + text);
  double share = p[n] + p[2 * n];
  for (std::size_t m = 1; m < n; ++m) share += kPart * p[m] + kBeside * p[n + m];
  return share;
}

// Patches that begin with the last `before` letters of it.
double beginningAmid(const std::string& text, std::size_t before, bool mixed,
                     const SequenceLikelihood& patch) {
  const std::size_t n = text.size();
  const std::string end = text.substr(n - before);
  const std::vector<double> p = patch.ofPrefixes(end + text + text.substr(0, n - before));
  double share = 0.0;
  for (std::size_t m = before; m < p.size(); ++m) {
    if (m >= before + n) {
      share += kBeside * p[m];
    } else if (m == before) {
      share += kPart * p[m];
    } else if (m >= n && mixed) {
      share += kTwoParts * p[m];
    }
  }
  return share;
}

double misread(const std::string& text, const SequenceLikelihood& patch) {
  const std::size_t n = text.size();
  const std::string pattern = patternOf(text);
  const std::vector<double> after = patch.ofPrefixes(text + pattern);
  double sum = 0.0;
  for (std::size_t m = 1; m <= n; ++m) {
    sum += after[n + m] + patch.ofPrefixes(pattern.substr(n - m) + text).back();
  }
  return kMisread * sum;
}

}  // namespace

std::size_t periodOf(const std::string& text) {
  const std::string pattern = patternOf(text);
  if (!isMixed(pattern)) return 0;
  for (std::size_t period = 2; period < pattern.size(); ++period) {
    const std::size_t again = pattern.size() - period;
    if (pattern.compare(period, again, pattern, 0, again) == 0) return period;
  }
  return 0;
}

double nameOdds(const std::string& name) {
  constexpr double kOdd = 0.05;
  constexpr double kPlainName = 0.3;
  if (name.empty()) return 1.0;
  double odds = periodOf(name) > 0 ? kOdd : 1.0;
  if (name.front() == '0' || name.front() == '-' || name.back() == '-') odds *= kOdd;
  if (!isMixed(patternOf(name))) odds *= kPlainName;
  return odds;
}

double shareOf(const std::string& text, const SequenceLikelihood& patch) {
  if (text.size() < 2) return text.empty() ? 0.0 : patch.ofPrefixes(text)[1];
  const bool mixed = isMixed(patternOf(text));
  double share = beginning(text, patch);
  for (std::size_t before = 1; before < text.size(); ++before) {
    share += beginningAmid(text, before, mixed, patch);
  }
  if (mixed) share += misread(text, patch);
  return std::min(1.0, share);
}

}  // namespace parkade
