// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/marker_counts.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <numeric>

namespace parkade {
namespace {

// The step, 1 or -1, that most neighbours differ by; none where few do.
std::optional<int> stepOf(const std::vector<CountedLine>& sorted) {
  constexpr int kLeast = 3;       // neighbours
  constexpr double kShare = 0.6;  // of them all
  int up = 0;
  int down = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const int by = sorted[i].number - sorted[i - 1].number;
    up += by == 1 ? 1 : 0;
    down += by == -1 ? 1 : 0;
  }
  const int most = std::max(up, down);
  if (most < kLeast || most < kShare * static_cast<double>(sorted.size() - 1)) return std::nullopt;
  return up > down ? 1 : -1;
}

// The number that both lines beside the k-th of the sorted ones leave for it.
std::optional<int> between(const std::vector<CountedLine>& sorted, std::size_t k, int step) {
  if (k == 0 || k + 1 >= sorted.size()) return std::nullopt;
  const int told = sorted[k - 1].number + step;
  return told == sorted[k + 1].number - step ? std::optional(told) : std::nullopt;
}

}  // namespace

std::vector<std::optional<int>> mendedCounts(const std::vector<CountedLine>& lines) {
  std::vector<std::optional<int>> mended(lines.size());
  std::vector<std::size_t> order(lines.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return lines[a].across < lines[b].across; });
  std::vector<CountedLine> sorted;
  for (const std::size_t i : order) sorted.push_back(lines[i]);
  const std::optional<int> step = stepOf(sorted);
  if (!step) return mended;
  const auto bearers = [&](int number) {
    return std::count_if(sorted.begin(), sorted.end(),
                         [&](const CountedLine& line) { return line.number == number; });
  };
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    const std::optional<int> told = between(sorted, k, *step);
    if (!told || *told == sorted[k].number) continue;
    if (bearers(sorted[k].number) > 1 && bearers(*told) == 0) mended[order[k]] = told;
  }
  return mended;
}

}  // namespace parkade
