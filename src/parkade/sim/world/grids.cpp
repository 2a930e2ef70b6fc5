// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "parkade/sim/world/layout.hpp"

namespace parkade::sim {
namespace {

/// A run of bays of one row, the kinds drawn by weight, one kind per run as builders do it.
std::string randomRow(const std::string& columns, double depth, const GarageStyle& style,
                      Random& random) {
  std::string row = columns;
  const bool slanted_fits = style.slot_length * std::sin(style.slant) <= depth - 0.1;
  char letter = 'P';
  bool draw = true;
  for (char& cell : row) {
    if (cell == '|') {
      draw = true;
      continue;
    }
    if (draw || random.chance(0.12)) {
      const double u = random.uniform();
      letter = u < 0.70 ? 'P' : u < 0.82 ? 'S' : u < 0.92 ? 'L' : u < 0.95 ? 'O' : 'H';
      if (letter == 'S' && !slanted_fits) letter = 'P';
      draw = false;
    }
    cell = letter == 'P' && random.chance(0.04) ? 'D' : letter;
  }
  return row;
}

/// Walled blocks: one run of bays of an island, through both rows.
void randomRooms(LayoutGrid& grid, Random& random) {
  for (LayoutGrid::Island& island : grid.islands) {
    if (!random.chance(0.45)) continue;
    const std::size_t length = static_cast<std::size_t>(random.integer(1, 3));
    const std::size_t start = random.index(island.lower.size());
    for (std::size_t c = start; c < std::min(start + length, island.lower.size()); ++c) {
      if (island.lower[c] == '|') break;
      island.lower[c] = island.upper[c] = 'R';
    }
  }
}

}  // namespace

LayoutGrid paperGrid() {
  LayoutGrid grid;
  grid.bottom = "|PPORP|PDPP|";
  grid.islands = {
      {"|PPPPP|PRRD|", "|PPPPP|PRRP|"},
      {"|PRRRP|PPPD|", "|PRRRP|PPPP|"},
      {"|SSSSS|RRRP|", "|SSSSS|RRRP|"},
      {"|PRRRR|RRRP|", "|PRRRR|RRRP|"},
  };
  grid.top = "|LLOLL|LRLL|";
  grid.left = "OLOLOLOLO";
  grid.right = "OPOPOPOPO";
  grid.left_depth = 4.5;
  grid.right_depth = 5.6;
  grid.entrance_aisle = 2;
  return grid;
}

LayoutGrid randomGrid(const GarageStyle& style, Random random) {
  // Area first, evenly in the logarithm: small garages are as frequent as large ones.
  const double area = std::exp(random.uniform(std::log(1700.0), std::log(11300.0)));
  const double aspect = random.uniform(0.9, 2.4);
  const double pitch = style.slots_per_bay * style.slot_width + style.pillar_size + 0.15;
  const double module = style.aisle_width + 2.0 * (style.slot_length + style.row_gap);
  const double height = std::sqrt(area / aspect);
  const double strip = style.slot_length + style.row_gap;
  const int islands = std::max(
      1, static_cast<int>(std::lround((height - 2.0 * strip - style.aisle_width) / module)));
  const double real_height = 2.0 * strip + style.aisle_width + islands * module;

  LayoutGrid grid;
  grid.bottom_depth = strip;
  grid.top_depth = strip;
  const bool left_row = random.chance(0.6);
  const bool right_row = random.chance(0.6);
  grid.left_depth = left_row ? strip : random.uniform(1.6, 3.0);
  grid.right_depth = right_row ? strip : random.uniform(1.6, 3.0);
  const int cells = std::max(
      5, static_cast<int>(
             std::lround((area / real_height - grid.left_depth - grid.right_depth + 2.0) / pitch)));
  std::string columns(static_cast<std::size_t>(cells), ' ');
  columns.front() = columns.back() = '|';
  if (cells >= 9 && random.chance(0.8)) {
    columns[static_cast<std::size_t>(cells / 2 + random.integer(-1, 1))] = '|';
  }
  grid.bottom = randomRow(columns, strip, style, random);
  for (int i = 0; i < islands; ++i) {
    grid.islands.push_back(
        {randomRow(columns, strip, style, random), randomRow(columns, strip, style, random)});
  }
  grid.top = randomRow(columns, strip, style, random);
  randomRooms(grid, random);
  const std::string side(2 * static_cast<std::size_t>(islands) + 1, ' ');
  if (left_row) grid.left = randomRow(side, strip, style, random);
  if (right_row) grid.right = randomRow(side, strip, style, random);
  if (random.chance(0.6)) {
    grid.entrance_aisle = random.integer(0, islands);
    if (left_row) grid.left[2 * static_cast<std::size_t>(grid.entrance_aisle)] = 'O';
  }
  return grid;
}

}  // namespace parkade::sim
