// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "parkade/io/stamps.hpp"

namespace parkade {

/// Steps longer than so many median ones are gaps.
inline constexpr double kGapSteps = 1.5;

/// Timing of one sensor. Steps are taken between rows in the order of time (after repair, where the
/// stamps need it).
struct StreamStatistics {
  std::size_t count = 0;
  TimeNs start_ns = 0;
  TimeNs end_ns = 0;
  double rate_hz = 0.0;         ///< 1 / median step
  double jitter_ms = 0.0;       ///< standard deviation of the steps that are no gaps
  std::size_t gaps = 0;         ///< steps above kGapSteps median ones
  double largest_gap_ms = 0.0;  ///< largest step; 0 where there is no gap
  StampReport stamps;
};

/// Timing of stamps in the order of a file.
StreamStatistics streamStatistics(const std::vector<TimeNs>& t_ns);

/// Rows that a reader would use, in the order of time: all, or what a repair of the stamps leaves.
std::vector<std::size_t> usableRows(const std::vector<TimeNs>& t_ns);

}  // namespace parkade
