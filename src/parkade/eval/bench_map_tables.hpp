// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "parkade/eval/bench_tables.hpp"
#include "parkade/eval/text_table.hpp"

namespace parkade {

/// Objects of the maps, class by class, summed over the runs of each method on drives as they are
/// (no condition). Methods whose maps hold no objects are left out; nothing where that is all.
std::optional<TextTable> objectTable(const std::vector<BenchRecord>& records,
                                     const std::vector<BenchMethod>& methods);

}  // namespace parkade
