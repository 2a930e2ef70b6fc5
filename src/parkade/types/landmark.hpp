// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace parkade {

/// A key-point landmark as the estimator has it.
struct Landmark {
  std::uint64_t id = 0;  ///< the track id that it stems from
  Eigen::Vector3d p_odom = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< m^2, of p_odom given the poses
  int num_observations = 0;
};

}  // namespace parkade
