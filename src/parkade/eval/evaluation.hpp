// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "parkade/eval/association.hpp"
#include "parkade/eval/consistency.hpp"
#include "parkade/eval/metrics.hpp"
#include "parkade/geometry/alignment.hpp"

namespace parkade {

struct EvaluationOptions {
  std::string align = "se3";
  AssociationOptions association;
  RpeOptions rpe;

  void visit(OptionVisitor& v) {
    v.field("align", align,
            "Alignment of the estimate with the reference: none; origin (the first pair of poses); "
            "yaw (heading about z and position); se3; sim3 (se3 with scale).",
            {"none", "origin", "yaw", "se3", "sim3"});
    v.group("association", association);
    v.group("rpe", rpe);
  }
};

/// How wrong cameras were told to sit on the car, and how wrong a drive found them: root mean
/// squares over cameras and axes; mean NEES of a camera's place and of its turn (3 each where what
/// was told of it is honest).
struct CameraErrors {
  int cameras = 0;
  double told_m = 0.0;
  double told_deg = 0.0;
  double found_m = 0.0;
  double found_deg = 0.0;
  double nees_place = 0.0;
  double nees_turn = 0.0;
};

/// How well an estimated trajectory agrees with a reference. Definitions: docs/evaluation.md.
struct Evaluation {
  EvaluationOptions options;
  Association pairs;    ///< the estimate's poses are aligned
  Trajectory estimate;  ///< all of it, aligned, on the reference's clock
  Alignment alignment;  ///< from the estimate's frame to the reference's

  AbsoluteError absolute;       ///< of every pair
  Statistics ape;               ///< m
  Statistics ape_rotation_deg;  ///< degrees
  Statistics ape_heading_deg;   ///< degrees about z
  RelativeError relative;       ///< of every pair of pairs
  Statistics rpe;               ///< m
  Statistics rpe_rotation_deg;  ///< degrees
  Drift drift;
  double final_error = 0.0;         ///< APE of the last pair, m
  double path_length = 0.0;         ///< of the reference's matched poses, m
  double estimate_path_length = 0;  ///< of the same poses of the estimate, aligned (and scaled), m
  double duration_s = 0.0;          ///< from the first pair to the last
  std::optional<PoseConsistency> consistency;  ///< set by the caller who has covariances
  std::optional<CameraErrors> cameras;         ///< set by the caller who knows the rig's truth

  std::vector<std::string> notes;  ///< what a reader must know to trust the figures
};

/// Associates, aligns, measures. Fails where nothing matches or an option makes no sense. A
/// degenerate alignment or a route too short for the RPE is no failure but a note.
Result<Evaluation> evaluate(const Trajectory& estimate, const Trajectory& reference,
                            const EvaluationOptions& options = {});

}  // namespace parkade
