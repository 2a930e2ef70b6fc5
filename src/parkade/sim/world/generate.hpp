// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "parkade/core/options.hpp"
#include "parkade/core/result.hpp"
#include "parkade/sim/garage.hpp"

namespace parkade::sim {

/// Letters of zones, row by row: without I and O, which look like digits.
inline constexpr std::string_view kZoneLetters = "ABCDEFGHJKLMNPQRSTUVWXYZ";

struct GarageOptions {
  std::string preset = "paper";
  int seed = 0;
  int parked_seed = -1;
  double occupancy = 0.6;
  double one_way = 0.0;
  std::string first_zone = "A";

  void visit(OptionVisitor& v) {
    v.field("preset", preset,
            "The garage: paper (9,000 m2, 157 slots) or random (another one for every seed).",
            {"paper", "random"});
    v.field("seed", seed, "",
            "Of the layout (random), of the places of parked cars, of wear and dirt.", 0, 1e9);
    v.field("parked_seed", parked_seed, "",
            "Of which slots hold a parked car; nothing else changes. -1: seed.", -1, 1e9);
    v.field("occupancy", occupancy, "share", "Share of the slots with a parked car.", 0.0, 1.0);
    v.field("one_way", one_way, "share",
            "Share of the aisles that are one-way (random), as far as all stay in reach.", 0.0,
            1.0);
    v.field("first_zone", first_zone,
            "Letter of the first row's zones, A to Z without I and O; the next rows follow it.");
  }
};

/// Makes a garage. The same options give the same garage. Fails on an unknown preset, an
/// occupancy or share of one-way aisles outside 0 to 1, one-way aisles in the preset "paper", or a
/// first zone that is none of kZoneLetters.
Result<Garage> generateGarage(const GarageOptions& options);

}  // namespace parkade::sim
