// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/core/result.hpp"

namespace parkade::sim {

/// Everything that a simulated recording depends on, but for the number of threads.
struct SimSpec {
  std::string garage = "paper";
  std::string route = "test1";
  int seed = 1;
  int garage_seed = 1;
  int parked_seed = -1;
  double lux = 200.0;
  double occupancy = 0.6;
  double one_way = 0.0;
  std::string first_zone = "A";
  int cars = 2;
  int people = 3;
  double speed_kmh = 15.0;
  std::string rig = "avp6";
  bool fast = false;
  int motion_blur = 1;
  double readout_ms = 0.0;
  bool noise = true;
  bool load = true;
  bool rolling_start = false;
  double duration = 0.0;
  double calib_error_deg = 0.0;
  double calib_error_cm = 0.0;
  bool images = true;
  int threads = 2;

  void visit(OptionVisitor& v);

  /// That of which slots hold which cars: the garage's, unless it has one of its own.
  [[nodiscard]] int parkedSeed() const { return parked_seed < 0 ? garage_seed : parked_seed; }
  /// "sim:paper/test1", for messages.
  [[nodiscard]] std::string name() const { return "sim:" + garage + "/" + route; }
};

/// The conditions that belong to a route (light, occupancy, agents, speed) where the user sets
/// none. Fails on an unknown garage or route, and names the known ones.
Result<SimSpec> defaultSpec(const std::string& garage, const std::string& route);

/// Sets fields from (name, value) pairs over the route's own conditions. `origin` tells the user
/// where a bad value stands: "--" for options of the command line, or the source's address.
Result<SimSpec> makeSpec(const std::string& garage, const std::string& route,
                         const std::vector<std::pair<std::string, std::string>>& values,
                         const std::string& origin);

/// Reads "sim:GARAGE/ROUTE?name=value&name=value". The garage alone means its route random, or
/// test1 in paper.
Result<SimSpec> parseSimAddress(const std::string& address);

/// Whether a source's address means the simulator.
bool isSimAddress(const std::string& address);

}  // namespace parkade::sim
