// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/random.hpp"
#include "parkade/core/result.hpp"
#include "parkade/sim/drive/path.hpp"
#include "parkade/sim/garage.hpp"

namespace parkade::sim {

/// A way along the aisle graph, before it is a path.
struct Way {
  std::vector<int> nodes;   ///< neighbours in the graph
  double trim_start = 0.0;  ///< m left out at the first node
  double trim_end = 0.0;    ///< m left out at the last node
  /// Turning round: at the last node the car passes on, reverses into the aisle towards this node
  /// and drives along `back`, which starts at that last node. -1: none.
  int reverse_into = -1;
  std::vector<int> back;
  /// Parking: the car stops in the last aisle beyond this slot and reverses into it. -1: none.
  int park_in = -1;  ///< index into Garage::slots
};

/// How a parking manoeuvre is driven.
struct ParkingStyle {
  double aisle_offset = 0.4;  ///< m that the car keeps off the centre, away from the slot
  double radius = 4.5;        ///< m
};

/// The path of the rear axle along a way. Fails where its corners do not fit.
Result<Path> pathAlong(const Way& way, const Garage& garage, const VehicleShape& car,
                       const ParkingStyle& parking, Random random);

/// Slots that a car driving from one node to the next may reverse into: perpendicular ones that
/// open to this aisle. Indices into Garage::slots.
std::vector<int> slotsBeside(const Garage& garage, int from, int to);

}  // namespace parkade::sim
