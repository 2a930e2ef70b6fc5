// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "parkade/imu/reading_buffer.hpp"
#include "parkade/vio/window.hpp"

namespace parkade {

/// One frame set before the start.
struct StartUpFrame {
  TimeNs t_ns = 0;
  int id = 0;
  Observations observations;
};

struct StartUpAlignment {
  bool ok = false;
  std::vector<NavState> states;  ///< per frame; first vehicle pose at the origin with yaw 0
  ImuBias bias;
  int num_features = 0;  ///< that the alignment rests on
};

/// States of a few frames of a car in motion, from tracks and readings alone: gyro bias from the
/// bearings' epipolar planes, then velocity, gravity and structure from one linear system, for any
/// number of cameras with or without overlap. docs/math/start_up.md. Not ok where too few features
/// are seen twice or the system is singular.
StartUpAlignment alignInMotion(const std::vector<VioCamera>& cameras,
                               const std::vector<StartUpFrame>& frames,
                               const ReadingBuffer& readings, const ImuNoise& noise, double gravity,
                               const SE3& T_imu_vehicle, double bias_gyro_sigma, TimeNs gap_ns);

/// The state of a car at rest: gravity from the mean specific force, gyro bias from the mean rate.
NavState alignAtRest(const Eigen::Vector3d& mean_accel, const SE3& T_imu_vehicle);

/// Gravity of the given magnitude that minimises 0.5 g' H g + b' g; H is positive semi-definite.
/// Exposed for its test.
Eigen::Vector3d solveOnSphere(const Eigen::Matrix3d& H, const Eigen::Vector3d& b, double radius);

}  // namespace parkade
