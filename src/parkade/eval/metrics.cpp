// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace parkade {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

void checkPaired(const Trajectory& estimate, const Trajectory& reference) {
  PARKADE_CHECK(estimate.size() == reference.size(), "{} estimated poses but {} reference poses",
                estimate.size(), reference.size());
}

// Distance along the path from the first pose to each.
std::vector<double> distances(const Trajectory& trajectory) {
  std::vector<double> result(trajectory.size(), 0.0);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    result[i] = result[i - 1] + (trajectory[i].T_world_body.translation() -
                                 trajectory[i - 1].T_world_body.translation())
                                    .norm();
  }
  return result;
}

// Index in (first, size) whose value is nearest to the target, of equal ones the first; values do
// not decrease. Returns size where first is the last index.
std::size_t nearestAfter(const std::vector<double>& values, std::size_t first, double target) {
  if (first + 1 >= values.size()) return values.size();
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first) + 1;
  auto it = std::lower_bound(begin, values.end(), target);
  if (it == values.end() || (it != begin && target - *(it - 1) <= *it - target)) --it;
  it = std::lower_bound(begin, values.end(), *it);
  return static_cast<std::size_t>(it - values.begin());
}

// Every pose with the pose nearest to delta further on, if within 10 % of delta.
IndexPairs allPairs(const std::vector<double>& values, double delta) {
  constexpr double kTolerance = 0.1;
  IndexPairs pairs;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t j = nearestAfter(values, i, values[i] + delta);
    if (j == values.size()) break;
    if (std::abs(values[j] - values[i] - delta) <= kTolerance * delta) pairs.emplace_back(i, j);
  }
  return pairs;
}

// One after the other by path. The first pair begins where the first delta is complete, not at the
// first pose: that is evo's rule, and the published figures depend on it.
IndexPairs consecutiveByPath(const Trajectory& estimate, double delta) {
  IndexPairs pairs;
  bool started = false;
  std::size_t previous = 0;
  double path = 0.0;
  for (std::size_t i = 1; i < estimate.size(); ++i) {
    path += (estimate[i].T_world_body.translation() - estimate[i - 1].T_world_body.translation())
                .norm();
    if (path < delta) continue;
    if (started) pairs.emplace_back(previous, i);
    started = true;
    previous = i;
    path = 0.0;
  }
  return pairs;
}

// One after the other by time, from the first pose on; where a pause leaves no pose near delta, the
// next pose starts afresh.
IndexPairs consecutiveByTime(const std::vector<double>& seconds, double delta) {
  constexpr double kTolerance = 0.1;
  IndexPairs pairs;
  std::size_t i = 0;
  while (true) {
    const std::size_t j = nearestAfter(seconds, i, seconds[i] + delta);
    if (j == seconds.size()) return pairs;
    if (std::abs(seconds[j] - seconds[i] - delta) <= kTolerance * delta) {
      pairs.emplace_back(i, j);
      i = j;
    } else {
      ++i;
    }
  }
}

IndexPairs pairsByFrames(std::size_t count, std::size_t delta, bool all_pairs) {
  IndexPairs pairs;
  for (std::size_t i = 0; i + delta < count; i += all_pairs ? 1 : delta) {
    pairs.emplace_back(i, i + delta);
  }
  return pairs;
}

std::vector<double> secondsFromStart(const Trajectory& trajectory) {
  std::vector<double> seconds;
  for (const auto& pose : trajectory) {
    seconds.push_back(toSeconds(pose.t_ns - trajectory.front().t_ns));
  }
  return seconds;
}

SE3 relativePoseError(const Trajectory& estimate, const Trajectory& reference, std::size_t i,
                      std::size_t j) {
  const SE3 Q = reference[i].T_world_body.inverse() * reference[j].T_world_body;
  const SE3 P = estimate[i].T_world_body.inverse() * estimate[j].T_world_body;
  return Q.inverse() * P;
}

double angle(const SO3& rotation) {
  return rotation.log().norm();
}

// The angle about z of a rotation split into one about z and one about an axis in the xy plane.
double twistAboutZ(const SO3& rotation) {
  const Eigen::Quaterniond& q = rotation.quaternion();
  return wrapAngle(2.0 * std::atan2(q.z(), q.w()));
}

}  // namespace

AbsoluteError absoluteError(const Trajectory& estimate, const Trajectory& reference) {
  checkPaired(estimate, reference);
  AbsoluteError error;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const SE3& est = estimate[i].T_world_body;
    const SE3& ref = reference[i].T_world_body;
    error.translation.push_back((est.translation() - ref.translation()).norm());
    error.rotation_deg.push_back(kDegPerRad * angle(ref.rotation().inverse() * est.rotation()));
    error.heading_deg.push_back(kDegPerRad *
                                std::abs(twistAboutZ(est.rotation() * ref.rotation().inverse())));
  }
  return error;
}

Result<RelativeError> relativeError(const Trajectory& estimate, const Trajectory& reference,
                                    const RpeOptions& options) {
  checkPaired(estimate, reference);
  if (!(options.delta > 0.0) || !std::isfinite(options.delta)) {
    return Error{fmt::format("the RPE's delta is {}: it must be above zero", options.delta)};
  }
  RelativeError error;
  if (options.unit == "m") {
    error.pairs = options.all_pairs ? allPairs(distances(estimate), options.delta)
                                    : consecutiveByPath(estimate, options.delta);
  } else if (options.unit == "s") {
    const auto seconds = secondsFromStart(estimate);
    if (!seconds.empty()) {
      error.pairs = options.all_pairs ? allPairs(seconds, options.delta)
                                      : consecutiveByTime(seconds, options.delta);
    }
  } else if (options.unit == "f") {
    if (options.delta < 1.0 || options.delta != std::floor(options.delta)) {
      return Error{fmt::format("the RPE's delta is {} frames: it must be a whole number from 1 on",
                               options.delta)};
    }
    if (options.delta < static_cast<double>(estimate.size())) {
      error.pairs = pairsByFrames(estimate.size(), static_cast<std::size_t>(options.delta),
                                  options.all_pairs);
    }
  } else {
    return Error{fmt::format("the RPE's unit is '{}': it must be m, s or f", options.unit)};
  }
  for (const auto& [i, j] : error.pairs) {
    const SE3 E = relativePoseError(estimate, reference, i, j);
    error.translation.push_back(E.translation().norm());
    error.rotation_deg.push_back(kDegPerRad * angle(E.rotation()));
  }
  return error;
}

Drift drift(const Trajectory& estimate, const Trajectory& reference) {
  checkPaired(estimate, reference);
  constexpr double kLongestStep = 100.0;  // m
  constexpr int kLengths = 8;
  constexpr std::size_t kStartEvery = 10;  // poses
  Drift result;
  if (estimate.empty()) return result;
  const std::vector<double> path = distances(reference);
  result.end_m =
      relativePoseError(estimate, reference, 0, estimate.size() - 1).translation().norm();
  if (path.back() <= 0.0) return result;
  result.end_percent = 100.0 * result.end_m / path.back();
  result.step_m = std::min(kLongestStep, path.back() / 10.0);
  double translation = 0.0;
  double rotation = 0.0;
  for (std::size_t i = 0; i < path.size(); i += kStartEvery) {
    for (int k = 1; k <= kLengths; ++k) {
      const double length = k * result.step_m;
      const auto end = std::upper_bound(path.begin(), path.end(), path[i] + length);
      if (end == path.end()) break;
      const SE3 E =
          relativePoseError(estimate, reference, i, static_cast<std::size_t>(end - path.begin()));
      translation += E.translation().norm() / length;
      rotation += angle(E.rotation()) / length;
      ++result.segments;
    }
  }
  if (result.segments > 0) {
    const double n = static_cast<double>(result.segments);
    result.percent = 100.0 * translation / n;
    result.deg_per_m = kDegPerRad * rotation / n;
  }
  return result;
}

}  // namespace parkade
