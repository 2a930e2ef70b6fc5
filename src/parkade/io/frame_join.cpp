// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/frame_join.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "parkade/core/median.hpp"

namespace parkade {

TimeNs medianStep(const std::vector<TimeNs>& t_ns) {
  if (t_ns.size() < 2) return 0;
  std::vector<TimeNs> steps;
  for (std::size_t i = 1; i < t_ns.size(); ++i) steps.push_back(t_ns[i] - t_ns[i - 1]);
  return median(std::move(steps));
}

TimeNs usualJoinTolerance(const std::vector<std::vector<TimeNs>>& stamps) {
  TimeNs tolerance = 5 * kNsPerMs;
  for (const std::vector<TimeNs>& camera : stamps) {
    const TimeNs period = medianStep(camera);
    if (period > 0) tolerance = std::min(tolerance, period / 2);
  }
  return tolerance;
}

Result<std::vector<JoinedFrame>> joinFrames(const std::vector<std::vector<TimeNs>>& stamps,
                                            TimeNs tolerance) {
  for (std::size_t camera = 0; camera < stamps.size(); ++camera) {
    const TimeNs period = medianStep(stamps[camera]);
    if (period > 0 && 2 * tolerance > period) {
      return Error{
          fmt::format("join tolerance {} ms is more than half the frame period ({} ms) of camera "
                      "number {}: choose at most {} ms",
                      toSeconds(tolerance) * 1e3, toSeconds(period) * 1e3, camera,
                      toSeconds(period / 2) * 1e3)};
    }
  }
  std::vector<JoinedFrame> frames;
  std::vector<std::size_t> heads(stamps.size(), 0);
  while (true) {
    TimeNs earliest = std::numeric_limits<TimeNs>::max();
    bool any = false;
    for (std::size_t camera = 0; camera < stamps.size(); ++camera) {
      if (heads[camera] == stamps[camera].size()) continue;
      earliest = std::min(earliest, stamps[camera][heads[camera]]);
      any = true;
    }
    if (!any) break;
    JoinedFrame frame;
    frame.images.assign(stamps.size(), -1);
    TimeNs sum = 0;  // of the distances to the earliest: no overflow
    TimeNs count = 0;
    for (std::size_t camera = 0; camera < stamps.size(); ++camera) {
      std::size_t& head = heads[camera];
      if (head == stamps[camera].size() || stamps[camera][head] - earliest > tolerance) continue;
      sum += stamps[camera][head] - earliest;
      ++count;
      frame.images[camera] = static_cast<int>(head++);
    }
    frame.t_ns = earliest + sum / count;
    frames.push_back(std::move(frame));
  }
  // Single images closer than the tolerance can leave means out of order.
  std::stable_sort(frames.begin(), frames.end(),
                   [](const JoinedFrame& a, const JoinedFrame& b) { return a.t_ns < b.t_ns; });
  return frames;
}

}  // namespace parkade
