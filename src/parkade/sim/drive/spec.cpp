// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/spec.hpp"

#include <fmt/core.h>

#include <cmath>

#include "parkade/sim/drive/routes.hpp"

namespace parkade::sim {
namespace {

constexpr const char* kScheme = "sim:";
const std::vector<std::string> kGarages{"paper", "random"};

}  // namespace

void SimSpec::visit(OptionVisitor& v) {
  v.field("garage", garage, "The garage: paper, or random with a seed of its own.", kGarages);
  v.field("route", route, "The route through it: test1 to test5 (paper), random (any).");
  v.field("seed", seed, "", "Of everything that happens on the drive: stops, people, noise.", 0,
          1e9);
  v.field("garage_seed", garage_seed, "", "Of the garage: layout, parked cars, wear.", 0, 1e9);
  v.field("parked_seed", parked_seed, "",
          "Of which slots hold which cars, in the same garage; -1: the garage's seed.", -1, 1e9);
  v.field("lux", lux, "lx", "Mean illuminance of the drivable floor.", 1.0, 5000.0);
  v.field("occupancy", occupancy, "share", "Share of the slots with a parked car.", 0.0, 1.0);
  v.field("one_way", one_way, "share",
          "Share of a random garage's aisles that are one-way, as far as all stay in reach.", 0.0,
          1.0);
  v.field("first_zone", first_zone,
          "Letter of the first row's zones, A to Z without I and O; the next rows follow it.");
  v.field("cars", cars, "count", "Cars that move about.", 0, 50);
  v.field("people", people, "count", "People who walk about.", 0, 100);
  v.field("speed_kmh", speed_kmh, "km/h", "Highest speed of the own car.", 2.0, 30.0);
  v.field("rig", rig, "Sensors of the car: a preset (avp6, nuscenes6, avm4) or a rig.yaml file.");
  v.field("fast", fast, "One sample per pixel, 2 x 2 only where a surface ends.");
  v.field("motion_blur", motion_blur, "count", "Sub-frames within an exposure; 1: none.", 1, 64);
  v.field("readout_ms", readout_ms, "ms",
          "Rolling shutter: time from the first row to the last; 0: the rig's own.", 0.0, 200.0);
  v.field("noise", noise, "Noise and errors of cameras, inertial unit and wheels.");
  v.field("load", load, "Static pitch and roll of passengers and luggage, drawn from the seed.");
  v.field("rolling_start", rolling_start, "Begin while the car is moving, instead of at rest.");
  v.field("duration", duration, "s", "Length at which the drive is cut short; 0: all of it.", 0.0,
          36000.0);
  v.field("calib_error_deg", calib_error_deg, "deg",
          "Standard deviation, about each axis, of how the cameras' told and true rotation differ.",
          0.0, 20.0);
  v.field("calib_error_cm", calib_error_cm, "cm",
          "Standard deviation, along each axis, of how the told and true place differ.", 0.0,
          100.0);
  v.field("images", images, "Whether the cameras deliver pictures.");
  v.field("threads", threads, "count", "Threads that draw; the bytes do not depend on it.", 1, 256);
}

Result<SimSpec> defaultSpec(const std::string& garage, const std::string& route) {
  if (std::find(kGarages.begin(), kGarages.end(), garage) == kGarages.end()) {
    return Error{fmt::format("garage '{}' is unknown; known are paper and random", garage)};
  }
  const Result<RouteInfo> info = findRoute(garage, route);
  if (!info) return info.error();
  SimSpec spec;
  spec.garage = garage;
  spec.route = route;
  spec.lux = info->lux;
  spec.occupancy = info->occupancy;
  spec.cars = info->cars;
  spec.people = info->people;
  spec.speed_kmh = std::round(info->max_speed * 36.0) / 10.0;
  return spec;
}

Result<SimSpec> makeSpec(const std::string& garage, const std::string& route,
                         const std::vector<std::pair<std::string, std::string>>& values,
                         const std::string& origin) {
  Result<SimSpec> spec = defaultSpec(garage, route);
  if (!spec) return Error{fmt::format("{}: {}", origin, spec.error().message)};
  for (const auto& [name, value] : values) {
    const std::string assignment = name + "=" + value;
    const Status status = setOption(asOptions(*spec), assignment);
    if (status) continue;
    // The options' message starts with where it thinks that the value stands.
    std::string message = status.error().message;
    const std::string prefix = "--set " + assignment + ": ";
    if (message.rfind(prefix, 0) == 0) message.erase(0, prefix.size());
    return Error{fmt::format("{}: {}", origin, message)};
  }
  if (spec->duration > 0.0 && spec->duration < 1.0) {
    return Error{fmt::format("{}: duration: expected 0 (all) or at least 1 s, found '{}'", origin,
                             spec->duration)};
  }
  return spec;
}

Result<SimSpec> parseSimAddress(const std::string& address) {
  if (!isSimAddress(address)) {
    return Error{
        fmt::format("'{}' is no simulator address (sim:GARAGE/ROUTE?name=value&...)", address)};
  }
  std::string rest = address.substr(std::string(kScheme).size());
  std::vector<std::pair<std::string, std::string>> values;
  const std::size_t question = rest.find('?');
  if (question != std::string::npos) {
    std::string query = rest.substr(question + 1);
    rest.erase(question);
    while (!query.empty()) {
      const std::size_t end = query.find('&');
      const std::string pair = query.substr(0, end);
      query = end == std::string::npos ? "" : query.substr(end + 1);
      if (pair.empty()) continue;
      const std::size_t equals = pair.find('=');
      if (equals == std::string::npos || equals == 0) {
        return Error{fmt::format("{}: expected name=value, found '{}'", address, pair)};
      }
      values.emplace_back(pair.substr(0, equals), pair.substr(equals + 1));
    }
  }
  const std::size_t slash = rest.find('/');
  const std::string garage = rest.substr(0, slash);
  const std::string route = slash != std::string::npos ? rest.substr(slash + 1)
                            : garage == "random"       ? "random"
                                                       : "test1";
  return makeSpec(garage, route, values, address);
}

bool isSimAddress(const std::string& address) {
  return address.rfind(kScheme, 0) == 0;
}

}  // namespace parkade::sim
