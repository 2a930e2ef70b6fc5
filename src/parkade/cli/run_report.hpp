// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "parkade/core/result.hpp"
#include "parkade/eval/charts.hpp"
#include "parkade/eval/evaluation.hpp"

namespace parkade::cli {

/// What is known from outside about where the car was.
struct ReportTruth {
  Evaluation evaluation;  ///< of the run's trajectory
  Trajectory reference;
  std::optional<GroundPicture> plan;  ///< of the garage, in the reference's frame
};

/// How long the stages of a run took, as bars.
std::string timingChart(const std::string& run_folder);

/// Writes a page about a run from the files of its folder: way, map, slots, layers, local map,
/// health, timing, pictures; with a truth also errors. What the method does not give is said in a
/// line in its place. Fails where the folder holds no trajectory or the page cannot be written.
Status writeRunReport(const std::string& run_folder, const std::string& page_path,
                      const std::optional<ReportTruth>& truth = {});

}  // namespace parkade::cli
