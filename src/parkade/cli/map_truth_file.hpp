// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "parkade/core/result.hpp"
#include "parkade/eval/charts.hpp"
#include "parkade/eval/map_truth.hpp"

namespace parkade::cli {

/// The truth of a simulated sequence as eval takes it: truth/garage.json, truth/agents.csv (where
/// it is there) and the ground truth's poses. Fails where the folder has no truth of its garage.
Result<MapTruth> readMapTruth(const std::string& sequence);

/// The garage's plan as a picture, in the truth's frame; nothing where the folder has no garage.
std::optional<GroundPicture> readPlanPicture(const std::string& sequence);

}  // namespace parkade::cli
