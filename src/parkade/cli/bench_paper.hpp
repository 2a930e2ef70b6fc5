// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "parkade/cli/bench_plan.hpp"
#include "parkade/cli/command.hpp"

namespace parkade::cli {

/// Adds the options of 'parkade bench [paper]' to the command.
std::shared_ptr<PaperBenchOptions> addPaperBenchOptions(CLI::App& bench);

/// Renders what is missing, runs, judges, and writes OUT/tables.md, metrics.json and report.html.
/// Returns the exit code, 1 also where a run or a recording failed (the tables are written all the
/// same). What can be known to be wrong before anything is drawn is.
int runPaperBench(PaperBenchOptions options);

}  // namespace parkade::cli
