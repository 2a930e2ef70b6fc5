// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/core/result.hpp"
#include "parkade/sim/drive/simulation.hpp"
#include "parkade/sim/scene.hpp"

namespace parkade::cli {

// The truth of a recording (docs/simulator.md, "What is written"); every file whole or not at all.

/// truth/trajectory.tum, truth/rig.yaml, truth/garage.json and
/// mav0/state_groundtruth_estimate0/data.csv below the sequence's folder.
Status writeTruth(const sim::Simulation& simulation, const std::string& sequence);

/// truth/agents.csv: where moving cars and people are at every frame set.
Status writeAgents(const sim::Simulation& simulation, const sim::Scene& scene,
                   const std::string& sequence);

/// The options that decide a recording's bytes, as YAML.
std::string specText(const sim::SimSpec& spec);

}  // namespace parkade::cli
