// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/core/result.hpp"
#include "parkade/types/pose_covariance.hpp"

namespace parkade {

// covariance.csv of a run (docs/formats.md, "Trajectories"): per pose its stamp in nanoseconds and
// the upper triangle of its covariance, row by row, 21 numbers.

/// Writes the covariances whole or not at all, with nine digits.
Status writePoseCovariances(const std::string& path, const PoseCovariances& covariances);

/// Fails with file, line and value on a wrong number of columns, text or NaN, and stamps that do
/// not increase.
Result<PoseCovariances> readPoseCovariances(const std::string& path);

}  // namespace parkade
