// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace parkade {

/// Covariance of a place (m) and a heading (deg), right perturbation of SE2.
Eigen::Matrix3d sharedNoise(double sigma_m, double sigma_deg);

/// Adds a covariance that all measurements with this one share to a measurement's information: only
/// in its observable directions.
Eigen::Matrix3d withSharedNoise(const Eigen::Matrix3d& information, const Eigen::Matrix3d& shared);

/// Standard deviation along the worst direction.
double largestSigma(const Eigen::Matrix2d& covariance);

}  // namespace parkade
