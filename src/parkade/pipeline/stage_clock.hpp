// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace parkade {

/// Time that one stage of the pipeline took, over all its calls.
struct StageTiming {
  std::string name;
  double mean_ms = 0.0;
  double p50_ms = 0.0;
  double p95_ms = 0.0;
  double max_ms = 0.0;
  std::int64_t count = 0;
};

/// Gathers durations in a fixed amount of memory: percentiles come from bins that are 2 % wide,
/// mean and maximum are exact.
class StageClock {
 public:
  explicit StageClock(std::string name) : name_(std::move(name)) {}
  void add(double milliseconds);
  [[nodiscard]] StageTiming timing() const;

 private:
  static constexpr int kBins = 1024;
  [[nodiscard]] double percentile(double share) const;

  std::string name_;
  std::array<std::int64_t, kBins> bins_{};
  std::int64_t count_ = 0;
  double sum_ms_ = 0.0;
  double max_ms_ = 0.0;
};

inline double millisecondsBetween(std::chrono::steady_clock::time_point begin,
                                  std::chrono::steady_clock::time_point end) {
  return std::chrono::duration<double, std::milli>(end - begin).count();
}

/// Wall time during which at least one of several stages was at work. Intervals may overlap and
/// come in any order.
class BusyTime {
 public:
  using Clock = std::chrono::steady_clock;
  void add(Clock::time_point begin, Clock::time_point end) { intervals_.emplace_back(begin, end); }
  void add(const BusyTime& other) {
    intervals_.insert(intervals_.end(), other.intervals_.begin(), other.intervals_.end());
  }
  [[nodiscard]] double seconds() const;

 private:
  std::vector<std::pair<Clock::time_point, Clock::time_point>> intervals_;
};

}  // namespace parkade
