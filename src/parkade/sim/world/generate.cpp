// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/generate.hpp"

#include <cmath>
#include <numeric>

#include "parkade/core/random.hpp"
#include "parkade/sim/world/layout.hpp"
#include "parkade/sim/world/style.hpp"

namespace parkade::sim {
namespace {

/// Exactly the asked share of the slots, to the nearest slot.
void parkCars(Garage& garage, double occupancy, Random random) {
  std::vector<std::size_t> order(garage.slots.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  random.shuffle(order);
  const auto count =
      static_cast<std::size_t>(std::lround(occupancy * static_cast<double>(garage.slots.size())));
  for (std::size_t i = 0; i < count; ++i) garage.slots[order[i]].occupied = true;
}

void numberSlots(Garage& garage) {
  for (Slot& slot : garage.slots) slot.number = std::to_string(slot.id);
}

}  // namespace

Result<Garage> generateGarage(const GarageOptions& options) {
  if (options.preset != "paper" && options.preset != "random") {
    return Error{"garage '" + options.preset + "' is unknown; known are paper and random"};
  }
  if (!(options.occupancy >= 0.0 && options.occupancy <= 1.0)) {
    return Error{fmt::format("occupancy {} is not between 0 and 1", options.occupancy)};
  }
  const auto seed = static_cast<std::uint64_t>(options.seed);
  const Random random = Random(seed).fork("garage");
  const GarageStyle style = makeStyle(options.preset, seed);
  Garage garage;
  garage.name = options.preset;
  garage.seed = seed;
  const LayoutGrid grid =
      options.preset == "paper" ? paperGrid() : randomGrid(style, random.fork("grid"));
  buildFromLayout(placeLayout(grid, style), style, garage);
  numberSlots(garage);
  parkCars(garage, options.occupancy, random.fork("occupancy"));
  return garage;
}

}  // namespace parkade::sim
