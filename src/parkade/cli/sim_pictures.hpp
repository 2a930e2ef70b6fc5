// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "parkade/core/result.hpp"
#include "parkade/sim/drive/simulation.hpp"

namespace parkade::cli {

/// Writes a plan of the route as a picture (PNG or JPEG by the name's end).
Status writePlan(const sim::Simulation& simulation, const std::string& path);

/// Writes the pictures of docs/simulator.md into a folder: every camera half way along the route,
/// the ground around the car and its labels from above, the whole garage, the plan.
Status writePictures(std::shared_ptr<const sim::Simulation> simulation, const std::string& folder);

}  // namespace parkade::cli
