// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "parkade/eval/bench_tables.hpp"
#include "parkade/eval/text_table.hpp"

namespace parkade {

/// Are the covariances of the poses honest? One NEES per run, its mean over time, the runs being
/// independent. Nothing where no run told covariances.
std::optional<TextTable> consistencyTable(const std::vector<BenchRecord>& records,
                                          const std::vector<BenchMethod>& methods);

/// How wrong the cameras were told to sit on the car, and how wrong the runs found them, condition
/// by condition. Nothing where no run refined them.
std::optional<TextTable> cameraTable(const std::vector<BenchRecord>& records);

}  // namespace parkade
