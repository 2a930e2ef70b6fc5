// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/cli/bench_runs.hpp"
#include "parkade/eval/text_table.hpp"

namespace parkade::cli {

/// Writes OUT/report.html: the tables, and for every drive the ways over the garage's plan, errors
/// over time, speed, maps on the truth, and pictures.
Status writeBenchReport(const PaperBenchOptions& options, const std::vector<JudgedRun>& runs,
                        const std::vector<TextTable>& tables, const std::string& setting);

}  // namespace parkade::cli
