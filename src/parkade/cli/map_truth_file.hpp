// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/core/result.hpp"
#include "parkade/eval/map_truth.hpp"

namespace parkade::cli {

/// The truth of a simulated sequence as eval takes it: truth/garage.json, truth/agents.csv (where
/// it is there) and the ground truth's poses. Fails where the folder has no truth of its garage.
Result<MapTruth> readMapTruth(const std::string& sequence);

}  // namespace parkade::cli
