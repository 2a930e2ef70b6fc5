// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// Uses a finished map as a planner would: which slots are free, nearest first, and what the grid
// says of a place.
//
//   03_use_a_map MAP.DB [X Y]
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "parkade/mapping/storage/map_file.hpp"

namespace {

using namespace parkade;

Eigen::Vector2d middleOf(const MapSlot& slot) {
  return 0.25 * (slot.corners[0] + slot.corners[1] + slot.corners[2] + slot.corners[3]);
}

void printFreeSlots(const ParkingMap& map, const Eigen::Vector2d& from) {
  constexpr double kFree = 0.8;  // what this planner asks for
  std::vector<const MapSlot*> free;
  for (const MapSlot& slot : map.slots) {
    if (slot.probability_free > kFree) free.push_back(&slot);
  }
  std::sort(free.begin(), free.end(), [&](const MapSlot* a, const MapSlot* b) {
    return (middleOf(*a) - from).norm() < (middleOf(*b) - from).norm();
  });
  fmt::print("{} of {} slots are free\n", free.size(), map.slots.size());
  constexpr std::size_t kTold = 5;
  for (std::size_t i = 0; i < std::min(kTold, free.size()); ++i) {
    const MapSlot& slot = *free[i];
    const Eigen::Vector2d entrance = 0.5 * (slot.corners[0] + slot.corners[1]);
    fmt::print("  slot {:4d} {:>4} entrance at {:7.2f} {:7.2f} m, {:.2f} m wide, free {:.0f} %\n",
               slot.id, slot.number, entrance.x(), entrance.y(),
               (slot.corners[1] - slot.corners[0]).norm(), 100.0 * slot.probability_free);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 4) {
    fmt::print(stderr, "usage: {} MAP.DB [X Y]\n", argv[0]);
    return 2;
  }
  const Result<ParkingMap> map = loadMap(argv[1]);
  if (!map) {
    fmt::print(stderr, "error: {}\n", map.error().message);
    return 1;
  }
  const Eigen::Vector2d place =
      argc == 4 ? Eigen::Vector2d(std::atof(argv[2]), std::atof(argv[3])) : Eigen::Vector2d::Zero();
  printFreeSlots(*map, place);

  fmt::print("the grid at {:.2f} {:.2f} m:\n", place.x(), place.y());
  for (const GridLayer layer : kGridLayers) {
    const GridCell cell = map->grid.at(layer, map->grid.cellOf(place));
    if (!cell.known()) continue;
    fmt::print(
        "  {:<16} {} with probability {:.2f}\n", kGridLayerNames[static_cast<std::size_t>(layer)],
        kSemanticClassNames[static_cast<std::size_t>(cell.semantic_class)], cell.probability());
  }
  return 0;
}
