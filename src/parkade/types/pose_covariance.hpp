// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/core/time.hpp"
#include "parkade/geometry/se3.hpp"

namespace parkade {

/// How sure an estimator says to be of a pose.
struct StampedPoseCovariance {
  TimeNs t_ns = 0;
  /// Of (translation, rotation), m and rad, right perturbation (T_truth = T_estimate * exp(error)),
  /// relative to the first pose of the trajectory.
  Matrix6d covariance = Matrix6d::Zero();
};

using PoseCovariances = std::vector<StampedPoseCovariance>;

}  // namespace parkade
