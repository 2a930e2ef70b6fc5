// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/association.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "parkade/core/median.hpp"

namespace parkade {
namespace {

struct Interval {
  TimeNs begin;
  TimeNs end;
};

// The stretches of time without a hole; single poses give an empty interval.
std::vector<Interval> stretches(const Trajectory& trajectory, double max_gap_s) {
  std::vector<Interval> result;
  const TimeNs longest = longestStep(trajectory, max_gap_s);
  for (const auto& pose : trajectory) {
    if (!result.empty() && pose.t_ns - result.back().end <= longest) {
      result.back().end = pose.t_ns;
    } else {
      result.push_back({pose.t_ns, pose.t_ns});
    }
  }
  return result;
}

double coverageOf(const Trajectory& estimate, const Trajectory& reference, double max_gap_s) {
  const auto known = stretches(reference, max_gap_s);
  const auto delivered = stretches(estimate, max_gap_s);
  TimeNs total = 0;
  TimeNs covered = 0;
  std::size_t j = 0;
  for (const Interval& span : known) {
    total += span.end - span.begin;
    while (j < delivered.size() && delivered[j].end < span.begin) ++j;
    for (std::size_t k = j; k < delivered.size() && delivered[k].begin <= span.end; ++k) {
      covered += std::max<TimeNs>(
          0, std::min(span.end, delivered[k].end) - std::max(span.begin, delivered[k].begin));
    }
  }
  // A reference of one instant has no duration; the caller found a match, so it is covered.
  return total > 0 ? static_cast<double>(covered) / static_cast<double>(total) : 1.0;
}

// Index of the pose nearest in time; of two equally near ones the earlier.
std::size_t nearest(const Trajectory& trajectory, TimeNs t_ns) {
  const auto after =
      std::lower_bound(trajectory.begin(), trajectory.end(), t_ns,
                       [](const StampedPose& pose, TimeNs t) { return pose.t_ns < t; });
  const auto index = static_cast<std::size_t>(after - trajectory.begin());
  if (index == trajectory.size()) return index - 1;
  if (index == 0) return 0;
  return t_ns - trajectory[index - 1].t_ns <= trajectory[index].t_ns - t_ns ? index - 1 : index;
}

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

// (index in the shorter, index in the longer), both ascending, each used once.
IndexPairs matchNearest(const Trajectory& shorter, const Trajectory& longer, TimeNs tolerance_ns) {
  IndexPairs pairs;
  for (std::size_t i = 0; i < shorter.size(); ++i) {
    const std::size_t j = nearest(longer, shorter[i].t_ns);
    const TimeNs difference = std::abs(shorter[i].t_ns - longer[j].t_ns);
    if (difference > tolerance_ns) continue;
    if (!pairs.empty() && pairs.back().second == j) {
      if (difference < std::abs(shorter[pairs.back().first].t_ns - longer[j].t_ns)) {
        pairs.back().first = i;
      }
      continue;
    }
    pairs.emplace_back(i, j);
  }
  return pairs;
}

void pairNearest(const Trajectory& estimate, const Trajectory& reference, TimeNs tolerance_ns,
                 Association& result) {
  const bool estimate_is_longer = estimate.size() > reference.size();
  const Trajectory& shorter = estimate_is_longer ? reference : estimate;
  const Trajectory& longer = estimate_is_longer ? estimate : reference;
  double sum = 0.0;
  for (const auto& [i, j] : matchNearest(shorter, longer, tolerance_ns)) {
    result.estimate.push_back(estimate[estimate_is_longer ? j : i]);
    result.reference.push_back(reference[estimate_is_longer ? i : j]);
    sum += std::abs(toSeconds(shorter[i].t_ns - longer[j].t_ns));
  }
  if (result.size() > 0) result.mean_difference_s = sum / static_cast<double>(result.size());
}

void pairInterpolated(const Trajectory& estimate, const Trajectory& reference, double max_gap_s,
                      Association& result) {
  const TimeNs longest = longestStep(reference, max_gap_s);
  std::size_t after = 0;
  for (const auto& pose : estimate) {
    while (after < reference.size() && reference[after].t_ns < pose.t_ns) ++after;
    if (after == reference.size()) break;
    const StampedPose& b = reference[after];
    if (b.t_ns == pose.t_ns) {
      result.estimate.push_back(pose);
      result.reference.push_back(b);
      continue;
    }
    if (after == 0) continue;
    const StampedPose& a = reference[after - 1];
    if (b.t_ns - a.t_ns > longest) continue;
    const double ratio =
        static_cast<double>(pose.t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
    result.estimate.push_back(pose);
    result.reference.push_back({pose.t_ns, interpolate(a.T_world_body, b.T_world_body, ratio)});
  }
}

void checkOrder(const Trajectory& trajectory, const char* name) {
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    PARKADE_CHECK(trajectory[i - 1].t_ns <= trajectory[i].t_ns,
                  "{}: pose {} at {} ns comes after pose {} at {} ns", name, i, trajectory[i].t_ns,
                  i - 1, trajectory[i - 1].t_ns);
  }
}

Error noMatch(const Trajectory& estimate, const Trajectory& reference,
              const AssociationOptions& options) {
  const TimeNs est_begin = estimate.front().t_ns;
  const TimeNs est_end = estimate.back().t_ns;
  const TimeNs ref_begin = reference.front().t_ns;
  const TimeNs ref_end = reference.back().t_ns;
  std::string message = fmt::format(
      "no pose of the estimate matches the reference: the estimate runs from {:.3f} s to {:.3f} s "
      "({} poses), the reference from {:.3f} s to {:.3f} s ({} poses); ",
      toSeconds(est_begin), toSeconds(est_end), estimate.size(), toSeconds(ref_begin),
      toSeconds(ref_end), reference.size());
  if (est_end < ref_begin || ref_end < est_begin) {
    return {message +
            fmt::format("they do not overlap. If only the clocks differ, give the offset from the "
                        "estimate's to the reference's clock (--offset {:.3f} would join their "
                        "starts)",
                        options.offset_s + toSeconds(ref_begin - est_begin))};
  }
  if (options.interpolate) {
    return {message + "every estimated pose falls into a hole of the reference: raise --max-gap"};
  }
  TimeNs least = std::abs(est_begin - ref_begin);
  for (const auto& pose : estimate) {
    least = std::min(least, std::abs(pose.t_ns - reference[nearest(reference, pose.t_ns)].t_ns));
  }
  return {message +
          fmt::format("the nearest two stamps are {:.6f} s apart, more than the tolerance "
                      "of {} s: raise --tolerance, or use --interpolate",
                      toSeconds(least), options.tolerance_s)};
}

}  // namespace

TimeNs longestStep(const Trajectory& trajectory, double max_gap_s) {
  if (trajectory.size() < 2) return fromSeconds(max_gap_s);
  std::vector<TimeNs> steps;
  steps.reserve(trajectory.size() - 1);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    steps.push_back(trajectory[i].t_ns - trajectory[i - 1].t_ns);
  }
  return std::max(fromSeconds(max_gap_s), 3 * median(std::move(steps)));
}

Result<Association> associate(const Trajectory& estimate, const Trajectory& reference,
                              const AssociationOptions& options) {
  checkOrder(estimate, "estimate");
  checkOrder(reference, "reference");
  if (estimate.empty()) return Error{"the estimate holds no pose"};
  if (reference.empty()) return Error{"the reference holds no pose"};
  Trajectory shifted = estimate;
  for (auto& pose : shifted) pose.t_ns += fromSeconds(options.offset_s);

  Association result;
  result.estimate_poses = estimate.size();
  result.reference_poses = reference.size();
  if (options.interpolate) {
    pairInterpolated(shifted, reference, options.max_gap_s, result);
  } else {
    pairNearest(shifted, reference, fromSeconds(options.tolerance_s), result);
  }
  if (result.size() == 0) return noMatch(shifted, reference, options);
  result.coverage = coverageOf(shifted, reference, options.max_gap_s);
  return result;
}

}  // namespace parkade
