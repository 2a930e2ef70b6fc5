// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "parkade/cli/bench_plan.hpp"

namespace parkade::cli {

/// A run that was judged, with everything that metrics.json keeps of it.
struct JudgedRun {
  BenchRecord record;
  nlohmann::ordered_json json;
  std::string sequence;  ///< folder of the recording
  std::string folder;    ///< of the run (or of the imported trajectories)
  std::string trajectory;
  bool kept = false;  ///< done by an earlier bench
};

/// Runs a variant on a recording, judges it and leaves OUT/runs/DRIVE/METHOD/bench.json, written
/// last. One that is there already and was made with the same options by the same program is kept.
/// Whatever goes wrong is a run that failed, with its reason.
JudgedRun performRun(const PaperBenchOptions& options, const BenchDrive& drive,
                     const BenchVariant& variant, const std::string& sequence);

/// The row of a run whose recording could not be made.
JudgedRun failedRun(const BenchDrive& drive, const BenchVariant& variant,
                    const std::string& reason);

}  // namespace parkade::cli
