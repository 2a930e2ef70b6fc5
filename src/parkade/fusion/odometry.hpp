// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "parkade/core/options.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/types/pose_estimate.hpp"

namespace parkade {

/// How the visual-inertial odometry errs between two frame sets, at least.
struct OdometryNoiseOptions {
  double translation = 0.00052;
  double yaw_deg = 0.0016;
  double height = 0.00085;
  double standing = 0.0004;
  double degraded_factor = 5.0;
  double told_share = 0.065;

  void visit(OptionVisitor& v) {
    v.field("translation", translation, "m/sqrt(m)", "Drift of the place, a random walk.", 1e-5,
            1.0);
    v.field("yaw_deg", yaw_deg, "deg/sqrt(m)", "Drift of the heading.", 1e-5, 10.0);
    v.field("height", height, "m/sqrt(m)", "Drift of the height.", 1e-5, 1.0);
    v.field("standing", standing, "m/sqrt(s)", "Drift of the place that time alone brings.", 1e-6,
            1.0);
    v.field("degraded_factor", degraded_factor, "ratio",
            "All of them grow by this where the odometry says that it is degraded or lost.", 1.0,
            1000.0);
    v.field("told_share", told_share, "ratio",
            "The growth of the odometry's own variance counts by this share, for it is told too "
            "large (but by all of it while the odometry is lost, and where it starts again).",
            0.01, 10.0);
  }
};

/// The levelled motion between two frame sets, as the filter predicts with it.
struct PlanarIncrement {
  SE2 T_before_after;
  double dz = 0.0;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< (x, y, angle) right, z
};

/// From the odometry's poses: the planar part of their motion. The covariance is the growth of the
/// odometry's own times told_share, where it grew, and not less than the options say.
/// docs/math/fusion.md, eq. (2).
PlanarIncrement planarIncrement(const PoseEstimate& before, const PoseEstimate& after,
                                const OdometryNoiseOptions& options);

/// A pose in space from the filter's pose over the ground and the odometry's pitch and roll.
SE3 liftPose(const SE2& T_world_vehicle, double z, const SE3& T_odom_vehicle);

}  // namespace parkade
