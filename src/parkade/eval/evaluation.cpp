// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/evaluation.hpp"

#include <cmath>
#include <optional>
#include <utility>

namespace parkade {
namespace {

Points3d positions(const Trajectory& trajectory) {
  Points3d points;
  points.reserve(trajectory.size());
  for (const auto& pose : trajectory) points.push_back(pose.T_world_body.translation());
  return points;
}

std::optional<Alignment> align(const Association& pairs, const std::string& method) {
  if (method == "none") return Alignment{};
  if (method == "origin") {
    return alignOrigin(pairs.estimate.front().T_world_body, pairs.reference.front().T_world_body);
  }
  const Points3d source = positions(pairs.estimate);
  const Points3d target = positions(pairs.reference);
  if (method == "yaw") return alignYaw(source, target);
  if (method == "se3") return alignSE3(source, target);
  if (method == "sim3") return alignSim3(source, target);
  return std::nullopt;
}

void alignPoses(const Alignment& alignment, Trajectory& trajectory) {
  for (auto& pose : trajectory) pose.T_world_body = alignment * pose.T_world_body;
}

std::string unitName(const std::string& unit) {
  if (unit == "m") return "m";
  return unit == "s" ? "s" : "frames";
}

void addNotes(Evaluation& result) {
  if (result.alignment.degenerate()) {
    result.notes.push_back(fmt::format(
        "the {} alignment is not fully determined ({}, {} pairs): do not trust rotation errors "
        "about the open direction",
        result.options.align, toString(result.alignment.degeneracy), result.pairs.size()));
  }
  if (result.relative.pairs.empty()) {
    result.notes.push_back(fmt::format(
        "no two poses are {} {} apart as the RPE needs (path {:.2f} m, {:.2f} s, {} poses){}: "
        "choose a smaller --rpe-delta",
        result.options.rpe.delta, unitName(result.options.rpe.unit), result.estimate_path_length,
        result.duration_s, result.pairs.size(),
        result.options.rpe.unit == "m" && !result.options.rpe.all_pairs
            ? "; the first pair begins where the first delta is complete"
            : ""));
  }
  if (result.drift.segments == 0) {
    result.notes.emplace_back("the route is too short to tell the drift");
  }
}

}  // namespace

Result<Evaluation> evaluate(const Trajectory& estimate, const Trajectory& reference,
                            const EvaluationOptions& options) {
  const AssociationOptions& matching = options.association;
  if (std::isnan(matching.tolerance_s + matching.max_gap_s + options.rpe.delta) ||
      !std::isfinite(matching.offset_s)) {
    return Error{fmt::format(
        "tolerance {} s, offset {} s, largest gap {} s, distance {} of pairs: expected "
        "numbers",
        matching.tolerance_s, matching.offset_s, matching.max_gap_s, options.rpe.delta)};
  }
  auto pairs = associate(estimate, reference, matching);
  if (!pairs) return pairs.error();
  Evaluation result;
  result.options = options;
  result.pairs = std::move(*pairs);
  const auto alignment = align(result.pairs, options.align);
  if (!alignment) {
    return Error{fmt::format("unknown alignment '{}': choose none, origin, yaw, se3 or sim3",
                             options.align)};
  }
  result.alignment = *alignment;
  result.estimate = estimate;
  for (auto& pose : result.estimate) pose.t_ns += fromSeconds(options.association.offset_s);
  alignPoses(result.alignment, result.estimate);
  alignPoses(result.alignment, result.pairs.estimate);

  const Trajectory& est = result.pairs.estimate;
  const Trajectory& ref = result.pairs.reference;
  auto relative = relativeError(est, ref, options.rpe);
  if (!relative) return relative.error();
  result.relative = std::move(*relative);
  result.absolute = absoluteError(est, ref);
  result.ape = describe(result.absolute.translation);
  result.ape_rotation_deg = describe(result.absolute.rotation_deg);
  result.ape_heading_deg = describe(result.absolute.heading_deg);
  result.rpe = describe(result.relative.translation);
  result.rpe_rotation_deg = describe(result.relative.rotation_deg);
  result.drift = drift(est, ref);
  result.final_error = result.absolute.translation.back();
  result.path_length = pathLength(ref);
  result.estimate_path_length = pathLength(est);
  result.duration_s = toSeconds(ref.back().t_ns - ref.front().t_ns);
  addNotes(result);
  return result;
}

}  // namespace parkade
