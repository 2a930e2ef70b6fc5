// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/stream_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "parkade/io/frame_join.hpp"

namespace parkade {

std::vector<std::size_t> usableRows(const std::vector<TimeNs>& t_ns) {
  if (!checkStamps(t_ns).clean()) {
    const Result<StampRepair> repair = repairStamps(t_ns);
    return repair ? repair->rows : std::vector<std::size_t>{};
  }
  std::vector<std::size_t> rows(t_ns.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  return rows;
}

StreamStatistics streamStatistics(const std::vector<TimeNs>& t_ns) {
  StreamStatistics stream;
  stream.stamps = checkStamps(t_ns);
  std::vector<TimeNs> ordered;
  for (const std::size_t row : usableRows(t_ns)) ordered.push_back(t_ns[row]);
  stream.count = t_ns.size();
  if (ordered.empty()) return stream;
  stream.start_ns = ordered.front();
  stream.end_ns = ordered.back();
  const TimeNs median = medianStep(ordered);
  if (median <= 0) return stream;
  stream.rate_hz = 1.0 / toSeconds(median);
  double sum = 0.0;
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 1; i < ordered.size(); ++i) {
    const double step_ms = toSeconds(ordered[i] - ordered[i - 1]) * 1e3;
    const double median_ms = toSeconds(median) * 1e3;
    if (step_ms > kGapSteps * median_ms) {
      ++stream.gaps;
      stream.largest_gap_ms = std::max(stream.largest_gap_ms, step_ms);
      continue;
    }
    sum += step_ms - median_ms;
    squares += (step_ms - median_ms) * (step_ms - median_ms);
    ++count;
  }
  if (count > 0) {
    const double mean = sum / static_cast<double>(count);
    stream.jitter_ms = std::sqrt(std::max(0.0, squares / static_cast<double>(count) - mean * mean));
  }
  return stream;
}

}  // namespace parkade
