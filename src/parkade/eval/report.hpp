// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/eval/evaluation.hpp"

namespace parkade {

/// Names and clock of the two trajectories, for people.
struct EvaluationLabels {
  std::string estimate = "estimate";
  std::string reference = "reference";
  bool by_index = false;                ///< the stamps number the poses (KITTI): matched by index
  TimeNs index_step_ns = kNsPerSecond;  ///< of one pose, where by_index
};

/// The figures as JSON (docs/evaluation.md, "Machine-readable"), ended by a newline. What could
/// not be measured is null.
std::string evaluationJson(const Evaluation& evaluation, const EvaluationLabels& labels = {});

/// The figures as a table of at most 100 columns, ended by a newline.
std::string evaluationTable(const Evaluation& evaluation, const EvaluationLabels& labels = {});

}  // namespace parkade
