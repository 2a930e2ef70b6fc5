// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/core/result.hpp"
#include "parkade/eval/statistics.hpp"
#include "parkade/types/trajectory.hpp"

namespace parkade {

// All functions here take an estimate and a reference of the same length whose poses belong
// together (association.hpp), the estimate aligned already. Definitions: docs/evaluation.md.

/// Absolute pose error of every pair.
struct AbsoluteError {
  std::vector<double> translation;   ///< |p_est - p_ref|, m
  std::vector<double> rotation_deg;  ///< angle of R_ref^-1 R_est, 0 to 180
  std::vector<double> heading_deg;  ///< the part of that rotation about the reference's z, 0 to 180
};
AbsoluteError absoluteError(const Trajectory& estimate, const Trajectory& reference);

struct RpeOptions {
  double delta = 10.0;
  std::string unit = "m";
  bool all_pairs = false;

  void visit(OptionVisitor& v) {
    v.field("delta", delta, "unit", "Distance between the two poses of a pair.", 1e-9);
    v.field("unit", unit, "Unit of delta: metres of path, seconds, or frames.", {"m", "s", "f"});
    v.field("all_pairs", all_pairs, "Pairs from every pose on, not only one after the other.");
  }
};

/// Relative pose error: E_ij = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) with reference Q and estimate P.
struct RelativeError {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< i, j
  std::vector<double> translation;                         ///< |trans(E_ij)|, m
  std::vector<double> rotation_deg;                        ///< angle of rot(E_ij)
};
/// Fails where the options make no sense; no pair at all is no failure.
Result<RelativeError> relativeError(const Trajectory& estimate, const Trajectory& reference,
                                    const RpeOptions& options);

/// Drift over the distance driven.
struct Drift {
  /// Mean of |trans(E_ij)| / length over sub-trajectories of 1 to 8 steps, in percent; a step is
  /// 100 m, as in the KITTI odometry benchmark, or a tenth of the path where that is less. NaN
  /// where nothing moves.
  double percent = kUnknown;
  double deg_per_m = kUnknown;    ///< mean of the rotation's angle / length, same sub-trajectories
  double step_m = kUnknown;       ///< see percent
  std::size_t segments = 0;       ///< sub-trajectories that entered
  double end_m = kUnknown;        ///< |trans(E_ij)| from the first to the last pose
  double end_percent = kUnknown;  ///< end_m / path, in percent

  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
};
Drift drift(const Trajectory& estimate, const Trajectory& reference);

}  // namespace parkade
