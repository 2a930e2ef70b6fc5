// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/routes.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "parkade/core/random.hpp"
#include "parkade/sim/drive/way.hpp"
#include "parkade/sim/world/aisle_graph.hpp"

namespace parkade::sim {
namespace {

// Ways that come nearer to an obstacle are not driven; slots count with their whole area, and
// inside one of 2.5 m a car leaves 0.3 m on both sides.
constexpr double kNearest = 0.25;         // m
constexpr double kNearestParking = 0.15;  // m

// The ways of the garage paper: five long aisles (rows, from the bottom) and three cross aisles
// (columns, from the left), node = 3 * row + column.
Way paperWay(const std::string& name) {
  Way way;
  if (name == "test1") {
    way.nodes = {3, 4, 7, 10, 9, 6, 3, 4};
    way.trim_start = 10.0;
    way.trim_end = 15.0;  // 25 m of the first aisle's 50 are driven twice
  } else if (name == "test2") {
    way.nodes = {2, 1, 4, 5, 8, 7, 10, 11, 14, 13};
    way.trim_start = 5.0;
    way.trim_end = 8.0;
  } else if (name == "test3") {
    way.nodes = {5, 4, 7, 10};
    way.trim_start = 6.0;
    way.reverse_into = 11;
    way.back = {10, 7, 4, 5};
    way.trim_end = 6.0;
  } else if (name == "test4") {
    way.nodes = {14, 13, 10, 9, 6, 3, 4, 1, 2};
    way.trim_start = 8.0;
    way.trim_end = 8.0;
  } else {
    way.nodes = {6, 7, 4, 5, 2, 1};
    way.trim_start = 8.0;
  }
  return way;
}

// A random walk without turning back on the spot, which likes aisles that it has not seen.
Way randomWay(const AisleGraph& graph, Random& random) {
  Way way;
  const AisleGraph::Edge& first = random.pick(graph.edges);
  way.nodes = {first.from, first.to};
  if (!first.one_way && random.chance(0.5)) std::swap(way.nodes[0], way.nodes[1]);
  const auto distance = [&graph](int a, int b) { return (graph.nodes[a] - graph.nodes[b]).norm(); };
  double length = distance(way.nodes[0], way.nodes[1]);
  way.trim_start = random.uniform(0.1, 0.6) * length;
  length -= way.trim_start;
  const double wished = random.uniform(110.0, 320.0);
  std::vector<std::pair<int, int>> seen{{first.from, first.to}};
  while (length < wished) {
    const int here = way.nodes.back();
    std::vector<int> choices;
    for (const int next : neighboursOf(graph, here)) {
      if (next == way.nodes[way.nodes.size() - 2]) continue;
      const bool known = std::find(seen.begin(), seen.end(), std::pair(here, next)) != seen.end() ||
                         std::find(seen.begin(), seen.end(), std::pair(next, here)) != seen.end();
      choices.insert(choices.end(), known ? 1 : 3, next);
    }
    if (choices.empty()) break;
    const int next = random.pick(choices);
    seen.emplace_back(here, next);
    length += distance(here, next);
    way.nodes.push_back(next);
  }
  const double last = distance(way.nodes.back(), way.nodes[way.nodes.size() - 2]);
  way.trim_end = random.uniform(0.1, 0.5) * last;
  return way;
}

struct Planned {
  Path path;
  Clearance clearance;
};

// The way in the manner that leaves the most room.
Result<Planned> planWay(const Way& way, const Garage& full, const VehicleShape& car,
                        const Random& random) {
  std::vector<ParkingStyle> styles{{}};
  if (way.park_in >= 0) styles = {{0.4, 4.5}, {0.7, 4.5}, {0.1, 4.5}, {0.6, 5.0}, {0.9, 5.0}};
  const int slot_id = way.park_in >= 0 ? full.slots[way.park_in].id : -1;
  Result<Planned> best = Error{"no way"};
  for (const ParkingStyle& style : styles) {
    Result<Path> path = pathAlong(way, full, car, style, random.fork("lane"));
    if (!path) {
      if (!best) best = path.error();
      continue;
    }
    const Clearance clearance = clearanceOf(*path, full, car, slot_id);
    if (!best || clearance.distance > best->clearance.distance) {
      best = Planned{std::move(path).value(), clearance};
    }
  }
  return best;
}

// Ends a way in one of the slots beside its last aisle; the roomiest of a few.
Result<Planned> planParking(Way& way, const Garage& full, const VehicleShape& car,
                            const Random& random) {
  const std::vector<int> slots =
      slotsBeside(full, way.nodes[way.nodes.size() - 2], way.nodes.back());
  Result<Planned> best = Error{"there is no perpendicular slot beside the last aisle"};
  int best_slot = -1;
  for (const int slot : slots) {
    way.park_in = slot;
    Result<Planned> planned = planWay(way, full, car, random);
    if (!planned) {
      if (!best) best = planned.error();
      continue;
    }
    if (!best || planned->clearance.distance > best->clearance.distance) {
      best = std::move(planned);
      best_slot = slot;
    }
  }
  way.park_in = best_slot;
  return best;
}

Result<Planned> checked(Result<Planned> planned, const Way& way, const std::string& what) {
  const double least = way.park_in >= 0 ? kNearestParking : kNearest;
  if (planned && planned->clearance.distance < least) {
    return Error{fmt::format("{}: the car would come within {:.2f} m of {} after {:.0f} m", what,
                             planned->clearance.distance, planned->clearance.obstacle,
                             planned->clearance.s)};
  }
  return planned;
}

Result<Planned> planRandom(Way& way, const Garage& full, const VehicleShape& car,
                           const Random& random) {
  Result<Planned> planned = Error{"the garage has no aisles"};
  constexpr int kTries = 80;
  for (int i = 0; i < kTries && !full.aisles.edges.empty(); ++i) {
    Random draws = random.fork("walk", i);
    way = randomWay(full.aisles, draws);
    planned =
        draws.chance(0.4) ? planParking(way, full, car, random) : planWay(way, full, car, random);
    planned = checked(std::move(planned), way, "random route");
    if (planned && planned->path.length() >= 60.0) return planned;
  }
  if (planned) return Error{"the garage is too small for a route of 60 m"};
  return planned;
}

// Where the car's front (or an axle) stands over a place, in the lane and heading that way; or < 0.
double distanceWhereOver(const Path& path, const Eigen::Vector2d& place, double heading,
                         double ahead, double half_width, double from) {
  constexpr double kStep = 0.1;
  double last = -1.0;
  for (double s = from; s < path.length(); s += kStep) {
    const PathPoint axle = path.at(s);
    const Eigen::Vector2d forward(std::cos(axle.heading), std::sin(axle.heading));
    const Eigen::Vector2d d = place - axle.position;
    const double gap = d.dot(forward) - ahead;
    const double across = std::abs(forward.x() * d.y() - forward.y() * d.x());
    const bool same_way = std::cos(axle.heading - heading) > 0.8 && axle.direction > 0;
    if (same_way && across < half_width && last > 0.0 && gap <= 0.0) return s;
    last = same_way && across < half_width ? gap : -1.0;
  }
  return -1.0;
}

void addStops(const Garage& garage, const VehicleShape& car, Random& random, Route& route) {
  const double front = car.wheelbase + car.front_overhang;
  for (const Marking& marking : garage.markings) {
    if (marking.semantic_class != SemanticClass::kStopLine) continue;
    constexpr double kLaneHalf = 1.6;  // m
    double from = 0.0;
    for (int pass = 0; pass < 4; ++pass) {
      const double s = distanceWhereOver(route.path, marking.position, marking.heading, front + 0.4,
                                         kLaneHalf, from);
      if (s < 0.0) break;
      if (random.chance(0.7)) route.stops.push_back({s, random.uniform(0.8, 2.5)});
      from = s + 5.0;
    }
  }
  // Something in the way: a stop that no line asks for.
  if (random.chance(0.5)) {
    route.stops.push_back(
        {random.uniform(0.25, 0.75) * route.path.length(), random.uniform(1.5, 4.0)});
  }
}

void addLimits(const Garage& garage, const VehicleShape& car, Route& route) {
  constexpr double kBumpSpeed = 2.2;     // m/s
  constexpr double kParkingSpeed = 1.6;  // m/s before the gear changes
  for (const Garage::Bump& bump : garage.bumps) {
    for (const double heading : {bump.heading, bump.heading + std::numbers::pi}) {
      double from = 0.0;
      for (int pass = 0; pass < 4; ++pass) {
        const double s = distanceWhereOver(route.path, bump.center, heading, car.wheelbase,
                                           0.5 * bump.width + 1.0, from);
        if (s < 0.0) break;
        route.limits.push_back({s - 1.0, s + car.wheelbase + 0.5, kBumpSpeed});
        from = s + 2.0;
      }
    }
  }
  for (const double s : route.path.gearChanges()) {
    route.limits.push_back({s - 8.0, s, kParkingSpeed});
  }
}

}  // namespace

const std::vector<RouteInfo>& routeCatalogue() {
  static const std::vector<RouteInfo> routes{
      {"paper", "test1", "a loop, closed with 25 m of overlap", 200.0, 0.60, 2, 3, 4.17},
      {"paper", "test2", "a serpentine through all five long aisles", 500.0, 0.40, 3, 4, 3.6},
      {"paper", "test3", "there and back, with a turn in reverse", 30.0, 0.80, 1, 3, 4.17},
      {"paper", "test4", "across the garage without any revisit", 1000.0, 0.20, 4, 6, 4.17},
      {"paper", "test5", "from the entrance to a slot, parked in reverse", 10.0, 0.95, 2, 2, 3.3},
      {"", "random", "drawn from the seed; some end parked", 200.0, 0.60, 2, 3, 4.17}};
  return routes;
}

Result<RouteInfo> findRoute(const std::string& garage, const std::string& name) {
  std::vector<std::string> known;
  for (const RouteInfo& info : routeCatalogue()) {
    if (!info.garage.empty() && info.garage != garage) continue;
    if (info.name == name) return info;
    known.push_back(info.name);
  }
  return Error{fmt::format("route '{}' is unknown in garage {}; known are {}", name, garage,
                           fmt::join(known, ", "))};
}

Result<Route> planRoute(const Garage& garage, const std::string& name, std::uint64_t seed,
                        const VehicleShape& car) {
  const Result<RouteInfo> info = findRoute(garage.name, name);
  if (!info) return info.error();
  Garage full = garage;
  for (Slot& slot : full.slots) slot.occupied = true;
  const Random random = Random(seed).fork("route");
  Way way;
  Result<Planned> planned = Error{"no way"};
  if (name == "random") {
    planned = planRandom(way, full, car, random);
  } else {
    way = paperWay(name);
    planned =
        name == "test5" ? planParking(way, full, car, random) : planWay(way, full, car, random);
    planned = checked(std::move(planned), way, "route " + name);
  }
  if (!planned) return planned.error();
  Route route;
  route.info = *info;
  route.path = std::move(planned->path);
  route.clearance = planned->clearance;
  if (way.park_in >= 0) route.parking_slot_id = full.slots[way.park_in].id;
  Random stops = random.fork("stops");
  addStops(garage, car, stops, route);
  addLimits(garage, car, route);
  return route;
}

}  // namespace parkade::sim
