// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "parkade/core/result.hpp"
#include "parkade/eval/map_evaluation.hpp"

namespace parkade::cli {

/// A map with where it lies in the truth.
struct PlacedMap {
  ParkingMap map;
  SE3 T_truth_map;  ///< turned about the vertical only
};

/// The map of a run's folder, placed by the run's first pose, or a map file, placed by its first
/// node. Fails where there is none, or the reference does not cover that instant.
Result<PlacedMap> loadPlacedMap(const std::string& path, const Trajectory& driven);

/// Adds 'eval map' to 'eval'.
void addEvalMapCommand(CLI::App& eval, int& exit_code);

}  // namespace parkade::cli
