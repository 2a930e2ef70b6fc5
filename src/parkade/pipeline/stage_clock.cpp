// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/stage_clock.hpp"

#include <algorithm>
#include <cmath>

namespace parkade {
namespace {

constexpr double kLeastMs = 1e-3;
constexpr double kRatio = 1.02;

}  // namespace

void StageClock::add(double milliseconds) {
  const double bin = std::log(std::max(milliseconds, kLeastMs) / kLeastMs) / std::log(kRatio);
  ++bins_[static_cast<std::size_t>(std::clamp(static_cast<int>(bin), 0, kBins - 1))];
  ++count_;
  sum_ms_ += milliseconds;
  max_ms_ = std::max(max_ms_, milliseconds);
}

double StageClock::percentile(double share) const {
  std::int64_t below = 0;
  for (int bin = 0; bin < kBins; ++bin) {
    below += bins_[static_cast<std::size_t>(bin)];
    if (below > 0 && static_cast<double>(below) >= share * static_cast<double>(count_)) {
      return std::min(max_ms_, kLeastMs * std::pow(kRatio, bin + 0.5));
    }
  }
  return max_ms_;
}

StageTiming StageClock::timing() const {
  const double mean = count_ > 0 ? sum_ms_ / static_cast<double>(count_) : 0.0;
  return {name_, mean, percentile(0.5), percentile(0.95), max_ms_, count_};
}

double BusyTime::seconds() const {
  auto intervals = intervals_;
  std::sort(intervals.begin(), intervals.end());
  Clock::time_point until{};
  double seconds = 0.0;
  for (const auto& [begin, end] : intervals) {
    const Clock::time_point from = std::max(begin, until);
    if (end <= from) continue;
    seconds += std::chrono::duration<double>(end - from).count();
    until = end;
  }
  return seconds;
}

}  // namespace parkade
