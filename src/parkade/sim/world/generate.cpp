// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/generate.hpp"

#include <cmath>
#include <numeric>

#include "parkade/core/random.hpp"
#include "parkade/sim/world/layout.hpp"
#include "parkade/sim/world/one_way.hpp"
#include "parkade/sim/world/paint.hpp"
#include "parkade/sim/world/style.hpp"

namespace parkade::sim {
namespace {

/// Exactly the asked share of the slots, to the nearest slot.
void parkCars(const GarageOptions& options, Garage& garage) {
  const int seed = options.parked_seed < 0 ? options.seed : options.parked_seed;
  Random random = Random(static_cast<std::uint64_t>(seed)).fork("garage").fork("occupancy");
  std::vector<std::size_t> order(garage.slots.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  random.shuffle(order);
  const auto count = static_cast<std::size_t>(
      std::lround(options.occupancy * static_cast<double>(garage.slots.size())));
  for (std::size_t i = 0; i < count; ++i) garage.slots[order[i]].occupied = true;
}

void numberSlots(Garage& garage) {
  for (Slot& slot : garage.slots) slot.number = std::to_string(slot.id);
}

/// Falls and ramps of a few percent; the ceiling stays level above the highest floor.
void tiltFloor(bool paper, Random random, Garage& garage) {
  const Eigen::Vector2d size = garage.max - garage.min;
  if (paper) {
    garage.ramps.push_back(
        {garage.min + Eigen::Vector2d(0.55 * size.x(), 0.0), Eigen::Vector2d::UnitX(), 26.0, 0.16});
  } else if (random.chance(0.5)) {
    const int count = random.integer(1, 2);
    for (int i = 0; i < count; ++i) {
      Garage::Ramp ramp;
      const double angle = random.integer(0, 3) * M_PI_2 + random.normal(0.0, 0.1);
      ramp.direction = {std::cos(angle), std::sin(angle)};
      ramp.length = random.uniform(12.0, 40.0);
      ramp.rise = 0.5 * random.uniform(0.004, 0.04) * ramp.length;
      ramp.start =
          garage.min +
          Eigen::Vector2d(random.uniform(0.2, 0.8), random.uniform(0.2, 0.8)).cwiseProduct(size) -
          0.5 * ramp.length * ramp.direction;
      garage.ramps.push_back(ramp);
    }
  }
  for (const Garage::Ramp& ramp : garage.ramps) garage.ceiling_height += ramp.rise;
  for (Pillar& pillar : garage.pillars) {
    pillar.height = garage.ceiling_height - garage.floorHeight(pillar.center);
  }
}

}  // namespace

Result<Garage> generateGarage(const GarageOptions& options) {
  if (options.preset != "paper" && options.preset != "random") {
    return Error{"garage '" + options.preset + "' is unknown; known are paper and random"};
  }
  if (!(options.occupancy >= 0.0 && options.occupancy <= 1.0)) {
    return Error{fmt::format("occupancy {} is not between 0 and 1", options.occupancy)};
  }
  if (!(options.one_way >= 0.0 && options.one_way <= 1.0)) {
    return Error{fmt::format("one_way: a share of {} of the aisles is not between 0 and 1",
                             options.one_way)};
  }
  if (options.one_way > 0.0 && options.preset != "random") {
    return Error{
        fmt::format("one_way: the aisles of garage '{}' are two-way; only those of random "
                    "garages can be one-way",
                    options.preset)};
  }
  if (options.first_zone.size() != 1 ||
      kZoneLetters.find(options.first_zone) == std::string_view::npos) {
    return Error{fmt::format("first_zone: '{}' is none of the letters {}", options.first_zone,
                             kZoneLetters)};
  }
  const auto seed = static_cast<std::uint64_t>(options.seed);
  const Random random = Random(seed).fork("garage");
  GarageStyle style = makeStyle(options.preset, seed);
  style.first_zone = options.first_zone.front();
  Garage garage;
  garage.name = options.preset;
  garage.seed = seed;
  const LayoutGrid grid =
      options.preset == "paper" ? paperGrid() : randomGrid(style, random.fork("grid"));
  const Layout layout = placeLayout(grid, style);
  buildFromLayout(layout, style, garage);
  if (options.one_way > 0.0) {
    makeOneWay(options.one_way, random.fork("one way"), garage.aisles);
  }
  tiltFloor(options.preset == "paper", random.fork("floor"), garage);
  numberSlots(garage);
  paintSlots(layout, style, garage);
  paintAisles(style, random.fork("aisles"), garage);
  placeSigns(layout, style, random.fork("signs"), garage);
  parkCars(options, garage);
  return garage;
}

}  // namespace parkade::sim
