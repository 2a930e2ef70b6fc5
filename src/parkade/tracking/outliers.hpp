// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "parkade/geometry/so3.hpp"
#include "parkade/tracking/options.hpp"

namespace parkade {

/// What is known of one camera's motion between two pictures before looking at them.
struct CameraMotion {
  bool rotation_valid = false;
  bool translation_valid = false;
  SO3 R_current_previous;                                        ///< camera frames
  Eigen::Vector3d t_current_previous = Eigen::Vector3d::Zero();  ///< m, camera frame now
};

/// Which features move as the camera does.
struct MotionConsensus {
  std::vector<std::uint8_t> inlier;  ///< one per feature; all 1 where nothing could be judged
  bool judged = false;
  double rms_px = 0.0;  ///< epipolar distance of the inliers
};

/// Judges features by their epipolar distance, with unit rays, so that any camera model will do.
/// The rotation comes from the IMU; the direction of travel is the prior's, or the best of many
/// pairs of features (two suffice where the rotation is known); both are then refined together by
/// robust least squares, since a gyro's unknown bias turns the prior. focal_px scales angles to
/// pixels. The same seed gives the same answer. docs/math/tracking.md.
MotionConsensus findConsensus(const std::vector<Eigen::Vector3d>& rays_previous,
                              const std::vector<Eigen::Vector3d>& rays_current,
                              const CameraMotion& motion, double focal_px,
                              const OutlierOptions& options, std::uint64_t seed);

}  // namespace parkade
