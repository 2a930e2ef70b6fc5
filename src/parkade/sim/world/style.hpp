// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "parkade/sim/garage.hpp"

namespace parkade::sim {

/// Everything about a garage that is taste, standard or state of repair, and not layout. The same
/// name and seed give the same style, so that a Garage read from a file can be drawn again.
struct GarageStyle {
  // Sizes, metres.
  double slot_width = 2.5;
  double slot_length = 5.0;
  double parallel_length = 6.0;
  double parallel_width = 2.2;
  double accessible_width = 3.3;
  double slant = 1.0471975511965976;  ///< rad between the aisle and a slanted slot
  double aisle_width = 6.0;
  int slots_per_bay = 3;  ///< perpendicular slots between two pillars
  double pillar_size = 0.7;
  bool round_pillars = false;
  double pillar_setback = 1.175;  ///< pillar centre behind the front of its row
  double row_gap = 0.35;          ///< between a slot's rear and the middle of an island or the wall
  double ceiling_height = 2.8;

  // Paint on the floor; colours are linear RGB reflectances.
  SlotMarking marking = SlotMarking::kClosed;
  std::map<int, SlotMarking> row_markings;  ///< rows that differ, in the layout's order
  double line_width = 0.12;
  Eigen::Vector3f line_colour{0.74F, 0.74F, 0.72F};
  Eigen::Vector3f arrow_colour{0.74F, 0.74F, 0.72F};
  Eigen::Vector3f guide_colour{0.72F, 0.48F, 0.05F};
  Eigen::Vector3f reserved_colour{0.06F, 0.16F, 0.55F};
  bool edge_lines = true;       ///< lines along both sides of the aisles
  bool centre_dashes = true;    ///< between the two directions
  double arrow_length = 2.4;    ///< m
  double arrow_spacing = 14.0;  ///< m between two arrows of one direction
  double limit_kmh = 10.0;
  double number_height = 0.4;  ///< m; 0: no painted numbers
  double number_depth = 0.12;  ///< place within the slot, share of its length from the entrance
  double text_weight = 0.16;   ///< stroke width of letters, share of their height
  bool wheel_stops = true;
  bool wheel_stop_pair = false;    ///< two short ones instead of a long one
  double wheel_stop_length = 1.7;  ///< m
  double crossing_share = 0.5;     ///< of the aisles' ends with a pedestrian crossing
  double bump_share = 0.35;        ///< of the long aisles' stretches with a speed bump
  double bump_height = 0.04;       ///< m
  double wear = 0.35;              ///< 0 fresh .. 1 nearly gone
  double dirt = 0.4;               ///< 0 clean .. 1 filthy

  // Floor.
  Eigen::Vector3f slot_floor{0.30F, 0.31F, 0.31F};
  Eigen::Vector3f aisle_floor{0.30F, 0.31F, 0.31F};
  bool two_tone = false;
  float floor_specular = 0.05F;
  float floor_roughness = 0.25F;
  double grain = 0.25;  ///< contrast of the fine texture

  // Walls, pillars, ceiling.
  Eigen::Vector3f wall_lower{0.04F, 0.30F, 0.30F};
  Eigen::Vector3f wall_upper{0.66F, 0.67F, 0.65F};
  double wall_band_height = 1.9;
  Eigen::Vector3f pillar_colour{0.70F, 0.70F, 0.68F};
  Eigen::Vector3f ceiling_colour{0.62F, 0.62F, 0.60F};
  std::vector<Eigen::Vector3f> zone_colours;
  bool guard_diagonal = true;  ///< yellow and black stripes, else corner strips
  double guard_height = 1.1;
  double zone_text_height = 0.4;
  double zone_text_center = 1.75;  ///< m above the floor
  int zone_faces = 4;              ///< pillar faces that carry the text
  int zone_scheme = 0;             ///< 0 "B12", 1 "B-12", 2 "B2", 3 "12B"
  char first_zone = 'A';           ///< letter of the first row of pillars
  bool zone_band = true;           ///< coloured band behind the text, else on the bare pillar
  double zone_share = 1.0;         ///< of the pillars that carry a marker

  double guide_share = 0.45;       ///< of the approaches to a crossing with a hanging sign
  double limit_sign_share = 0.08;  ///< of the pillars with a speed-limit plate

  // Light.
  double lamp_spacing = 6.0;   ///< m along an aisle
  bool lamps_across = false;   ///< tubes across the aisle, else along
  bool lamps_in_line = false;  ///< one line over the middle, else one over each lane, staggered
  bool tray_dark = true;       ///< cable trays above the lamps
  double lamp_dead_share = 0.0;
  double lamp_flicker_share = 0.0;
  Eigen::Vector3f lamp_colour{1.0F, 0.97F, 0.92F};
  bool daylight = true;
};

/// The style of the garage of this name ("paper", "random") and seed.
GarageStyle makeStyle(const std::string& name, std::uint64_t seed);

}  // namespace parkade::sim
