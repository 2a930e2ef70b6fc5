// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/geometry/se3.hpp"
#include "parkade/types/pose_estimate.hpp"

namespace parkade {

/// How uncertain a rig is in what all its pictures share, so that none of them shows it.
struct RigSigma {
  double length = 0.0;  ///< relative standard deviation of all lengths
  /// rad: of the cameras' common turn against the car, about the car's axes
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
};

/// Relative standard deviation of all lengths that a rig measures: where its cameras stand on one
/// another is what tells lengths, and a rig that is larger by a share draws a world that is larger
/// by it, in every picture alike. places: of the cameras (m, any one frame); covariance: of these
/// places, 3n x 3n, in the same axes (checked). 0 for fewer than two places.
/// docs/math/residuals.md, eq. (10b).
double lengthSigma(const std::vector<Eigen::Vector3d>& places, const Eigen::MatrixXd& covariance);

/// Standard deviations of the cameras' common turn (rad), about the axes that covariance, 3n x 3n
/// (checked), tells each camera's turn about. 0 for no camera. Equation (10c) there.
Eigen::Vector3d commonTurnSigma(const Eigen::MatrixXd& covariance);

/// What an uncertain rig makes of the way from the first pose. One error for the whole drive that
/// the odometry learns: what it was early stays in the way driven then. Equation (10d) there.
class RigErrorOnWay {
 public:
  /// The car has moved to odom, the odometry's pose; T_world_vehicle: where it is told to be.
  void advance(const SE3& T_odom_vehicle, const SE3& T_world_vehicle, const RigSigma& sigma);
  /// Adds the error of the way so far to the covariance of the place told.
  void addTo(PoseEstimate& estimate) const;

 private:
  bool moved_ = false;
  SE3 last_T_odom_vehicle_;
  /// World axes, m: by lengths, and by turns about the car's x, y and z.
  Eigen::Matrix<double, 3, 4> error_ = Eigen::Matrix<double, 3, 4>::Zero();
};

}  // namespace parkade
