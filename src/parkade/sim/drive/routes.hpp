// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/result.hpp"
#include "parkade/sim/drive/clearance.hpp"
#include "parkade/sim/drive/path.hpp"
#include "parkade/sim/drive/speed_profile.hpp"
#include "parkade/sim/garage.hpp"

namespace parkade::sim {

/// A named route and the conditions that belong to it unless the user sets others.
struct RouteInfo {
  std::string garage;  ///< "paper"; empty: any
  std::string name;
  std::string shape;  ///< in words
  double lux = 200.0;
  double occupancy = 0.6;
  int cars = 2;             ///< moving
  int people = 2;           ///< walking
  double max_speed = 4.17;  ///< m/s
};

/// test1 to test5 of the garage paper, and random for any garage.
const std::vector<RouteInfo>& routeCatalogue();
/// Fails on a name that the garage does not have, and lists those it has.
Result<RouteInfo> findRoute(const std::string& garage, const std::string& name);

/// A way through a garage, ready to be driven.
struct Route {
  RouteInfo info;
  Path path;
  std::vector<Stop> stops;
  std::vector<SpeedLimit> limits;
  int parking_slot_id = -1;  ///< where it ends parked in a slot
  Clearance clearance;       ///< to everything that stands, with all other slots occupied
};

/// Plans a route on the aisles of a garage. It depends on the layout and the seed (places in the
/// lane, stops, and the whole way of the route random), not on which slots are occupied. Fails
/// where the route is unknown or the aisles are too narrow for the car.
Result<Route> planRoute(const Garage& garage, const std::string& name, std::uint64_t seed,
                        const VehicleShape& car);

}  // namespace parkade::sim
