// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/cli/bench_plan.hpp"

namespace parkade::cli {

/// Adds the drive under each condition that the options sweep, one at a time: light, occupancy,
/// moving cars and people, calibration errors. Fails, and names the option, on what cannot be.
Status addConditions(const PaperBenchOptions& options, const BenchDrive& base,
                     std::vector<BenchDrive>& kinds);

}  // namespace parkade::cli
