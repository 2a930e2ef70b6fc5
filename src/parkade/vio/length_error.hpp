// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/types/pose_estimate.hpp"

namespace parkade {

/// Relative standard deviation of all lengths that a rig measures: where its cameras stand on one
/// another is what tells lengths, and a rig that is larger by a share draws a world that is larger
/// by it, in every picture alike. places: of the cameras (m, any one frame); covariance: of these
/// places, 3n x 3n, in the same axes (checked). 0 for fewer than two places.
/// docs/math/residuals.md, eq. (10b).
double lengthSigma(const std::vector<Eigen::Vector3d>& places, const Eigen::MatrixXd& covariance);

/// Adds to the covariance of a pose's place what lengths of that relative standard deviation do to
/// its way from the first pose, the origin of its frame.
void addLengthError(double sigma, PoseEstimate& estimate);

}  // namespace parkade
