// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/core/result.hpp"
#include "parkade/eval/evaluation.hpp"

namespace parkade::cli {

/// How wrong a run's cameras were told to sit and how wrong it found them ("calibration" in
/// FOLDER/metrics.json), by the true rig of a simulated drive (SEQUENCE/truth/rig.yaml): sets
/// evaluation.cameras. Without these files, or where the run refined nothing, it stays unset; fails
/// where one is broken or names other cameras.
Status judgeCameras(const std::string& folder, const std::string& sequence, Evaluation& evaluation);

}  // namespace parkade::cli
