// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "parkade/camera/rig.hpp"

namespace parkade {

/// How much a camera sees: the angle between the rays of the first and last pixel that has one, in
/// the row and the column through the optical axis. Radians.
struct FieldOfView {
  double horizontal = 0.0;
  double vertical = 0.0;
};
FieldOfView fieldOfView(const Camera& camera);

/// Where a camera looks from the vehicle: yaw of the optical axis (left positive), pitch (down
/// positive), roll about the axis (0: the image's rows are level; positive: the camera leans to its
/// right). Radians.
struct ViewDirection {
  double yaw = 0.0;
  double pitch = 0.0;
  double roll = 0.0;
};
ViewDirection viewDirection(const SE3& T_vehicle_cam);

/// The rig for a reader at a terminal: cameras, IMU, vehicle.
std::string rigText(const Rig& rig);
nlohmann::json rigJson(const Rig& rig);
/// [x, y, z]
nlohmann::json vectorJson(const Eigen::Vector3d& v);

}  // namespace parkade
