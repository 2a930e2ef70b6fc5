// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/camera_places.hpp"

#include "parkade/camera/rig.hpp"

namespace parkade::sim {

CameraPlaces::CameraPlaces(const CameraMotion& motion, double t, int rows)
    : middle_(motion.T_world_vehicle(t) * motion.T_vehicle_cam) {
  if (motion.readout_time <= 0.0) return;
  rows_.reserve(static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    const double at = t + rowTimeOf(motion.readout_time, row, rows);
    rows_.emplace_back(motion.T_world_vehicle(at) * motion.T_vehicle_cam);
  }
}

}  // namespace parkade::sim
