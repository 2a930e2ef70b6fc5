// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "parkade/camera/rig.hpp"
#include "parkade/sim/drive/path.hpp"
#include "parkade/sim/garage.hpp"

namespace parkade::sim {

/// Where a car that follows a path comes nearest to something that stands still.
struct Clearance {
  double distance = std::numeric_limits<double>::infinity();  ///< m; < 0: it would touch
  double s = 0.0;                                             ///< travelled distance there
  std::string obstacle;                                       ///< "pillar 12", "slot 7", "wall"
};

/// Sweeps the car's outline along the path, past pillars, rooms, outer walls and occupied slots
/// (but one, in which the path ends). Distances beyond reach are not looked at.
Clearance clearanceOf(const Path& path, const Garage& garage, const VehicleShape& car,
                      int free_slot_id = -1);

}  // namespace parkade::sim
