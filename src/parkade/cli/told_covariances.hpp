// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/core/result.hpp"
#include "parkade/eval/evaluation.hpp"

namespace parkade::cli {

/// Whether the covariances that a run told (FOLDER/covariance.csv) are honest: sets
/// evaluation.consistency. Without that file, or where nothing can be judged, it stays unset; fails
/// where the file is broken.
Status judgeCovariances(const std::string& folder, const Trajectory& estimate,
                        const Trajectory& reference, const AssociationOptions& association,
                        Evaluation& evaluation);

}  // namespace parkade::cli
