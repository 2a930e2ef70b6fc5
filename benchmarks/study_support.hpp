// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <string>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/eval/consistency.hpp"
#include "parkade/eval/evaluation.hpp"
#include "parkade/io/trajectory_io.hpp"

namespace parkade {

// What studies of recorded drives share.

/// Sets options one after the other, up to the first that is wrong.
template <class Options>
Status setAll(Options& options, const std::vector<std::string>& sets) {
  for (const std::string& set : sets) {
    if (Status status = setOption(asOptions(options), set); !status) return status;
  }
  return {};
}

/// A drive's poses against the truth, first pose joined unless aligned; 0 where nothing matches.
struct PoseScore {
  double rmse = 0.0;     ///< m
  double aligned = 0.0;  ///< m, SE(3)
  double heading_deg = 0.0;
  double nees_position = 0.0;
  double nees_yaw = 0.0;
};

inline PoseScore scorePoses(const Trajectory& estimate, const PoseCovariances& covariances,
                            const Trajectory& truth) {
  PoseScore score;
  EvaluationOptions how;
  how.align = "origin";
  if (const auto joined = evaluate(estimate, truth, how)) {
    score.rmse = joined->ape.rmse;
    score.heading_deg = joined->ape_heading_deg.rmse;
  }
  how.align = "se3";
  if (const auto aligned = evaluate(estimate, truth, how)) score.aligned = aligned->ape.rmse;
  if (const auto consistency = poseConsistency(estimate, covariances, truth)) {
    score.nees_position = consistency->position;
    score.nees_yaw = consistency->yaw;
  }
  return score;
}

/// Says so where it cannot.
inline void writePoses(const std::string& path, const Trajectory& poses) {
  if (Status written = writeTrajectory(path, poses, TrajectoryFormat::kTum); !written) {
    fmt::print(stderr, "{}\n", written.error().message);
  }
}

}  // namespace parkade
