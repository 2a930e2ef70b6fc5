// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/style.hpp"

#include "parkade/core/random.hpp"

namespace parkade::sim {
namespace {

const std::vector<Eigen::Vector3f>& zonePalette() {
  static const std::vector<Eigen::Vector3f> colours = {
      {0.04F, 0.30F, 0.30F}, {0.55F, 0.08F, 0.05F}, {0.05F, 0.16F, 0.48F}, {0.60F, 0.30F, 0.03F},
      {0.10F, 0.32F, 0.08F}, {0.30F, 0.08F, 0.34F}, {0.62F, 0.50F, 0.06F}, {0.10F, 0.36F, 0.55F}};
  return colours;
}

struct Standard {
  double slot_width;
  double slot_length;
  double parallel_length;
  double parallel_width;
  double accessible_width;
  double aisle_width;
};

/// Slot and aisle sizes of the countries in docs/simulator.md.
constexpr std::array<Standard, 8> kStandards = {{
    {2.50, 5.00, 6.0, 2.2, 3.3, 6.0},   // Korea
    {2.60, 5.20, 6.0, 2.2, 3.3, 6.2},   // Korea, extended
    {2.40, 5.30, 6.0, 2.4, 3.6, 5.5},   // China
    {2.30, 5.00, 5.7, 2.1, 3.5, 6.5},   // Germany, free sides
    {2.50, 5.00, 5.8, 2.3, 3.5, 6.0},   // Germany, wide
    {2.59, 5.49, 6.7, 2.44, 3.9, 7.3},  // United States
    {2.74, 5.49, 7.0, 2.44, 3.9, 7.3},  // United States, wide
    {2.40, 4.80, 6.0, 2.2, 3.6, 6.0},   // United Kingdom
}};

void drawSizes(GarageStyle& style, Random random) {
  const Standard& standard = random.pick(kStandards);
  style.slot_width = standard.slot_width;
  style.slot_length = standard.slot_length;
  style.parallel_length = standard.parallel_length;
  style.parallel_width = standard.parallel_width;
  style.accessible_width = standard.accessible_width;
  style.aisle_width = standard.aisle_width + random.uniform(0.0, 0.5);
  style.slant = random.pick(std::array<double, 3>{45.0, 60.0, 70.0}) * M_PI / 180.0;
  style.slots_per_bay = random.chance(0.75) ? 3 : 2;
  style.pillar_size = random.uniform(0.5, 0.9);
  style.round_pillars = random.chance(0.2);
  style.pillar_setback = random.uniform(0.9, 1.6);
  style.row_gap = random.uniform(0.15, 0.6);
  style.ceiling_height = random.uniform(2.5, 3.4);
}

void drawPaint(GarageStyle& style, Random random) {
  constexpr std::array<SlotMarking, 6> kMarkings = {SlotMarking::kClosed,  SlotMarking::kClosed,
                                                    SlotMarking::kTShaped, SlotMarking::kTShaped,
                                                    SlotMarking::kLShaped, SlotMarking::kOpen};
  style.marking = random.pick(kMarkings);
  for (int row = 0; row < 14; ++row) {
    if (random.chance(0.12)) style.row_markings[row] = random.pick(kMarkings);
  }
  style.line_width = random.uniform(0.08, 0.16);
  const float white = static_cast<float>(random.uniform(0.55, 0.82));
  style.line_colour = Eigen::Vector3f(white, white, white * 0.97F);
  style.arrow_colour = style.line_colour;
  const float yellow = static_cast<float>(random.uniform(0.75, 1.1));
  style.guide_colour *= yellow;
  if (random.chance(0.15)) style.line_colour = style.guide_colour;
  if (random.chance(0.15)) style.arrow_colour = style.guide_colour;
  style.edge_lines = random.chance(0.55);
  style.centre_dashes = random.chance(0.5);
  style.arrow_length = random.uniform(1.5, 3.2);
  style.arrow_spacing = random.uniform(9.0, 20.0);
  style.limit_kmh = random.pick(std::array<double, 5>{5.0, 5.0, 10.0, 10.0, 20.0});
  style.number_height = random.chance(0.75) ? random.uniform(0.22, 0.6) : 0.0;
  style.number_depth = random.chance(0.7) ? random.uniform(0.08, 0.2) : random.uniform(0.6, 0.85);
  style.text_weight = random.uniform(0.11, 0.2);
  style.wheel_stops = random.chance(0.8);
  style.wheel_stop_pair = random.chance(0.4);
  style.wheel_stop_length = random.uniform(1.5, 2.0);
  style.crossing_share = random.uniform(0.1, 0.7);
  style.bump_share = random.uniform(0.0, 0.7);
  style.bump_height = random.uniform(0.03, 0.05);
  style.wear = random.uniform(0.0, 0.9);
  style.dirt = random.uniform(0.0, 1.0);
}

void drawFloor(GarageStyle& style, Random random) {
  struct Look {
    Eigen::Vector3f colour;
    float specular_low, specular_high, roughness_low, roughness_high, grain;
  };
  const std::array<Look, 9> looks = {{
      {{0.28F, 0.29F, 0.30F}, 0.04F, 0.06F, 0.08F, 0.35F, 0.15F},  // epoxy, grey
      {{0.40F, 0.41F, 0.41F}, 0.04F, 0.06F, 0.08F, 0.35F, 0.15F},  // epoxy, light grey
      {{0.07F, 0.24F, 0.12F}, 0.04F, 0.06F, 0.08F, 0.35F, 0.15F},  // epoxy, green
      {{0.33F, 0.08F, 0.06F}, 0.04F, 0.06F, 0.08F, 0.35F, 0.15F},  // epoxy, red
      {{0.07F, 0.17F, 0.34F}, 0.04F, 0.06F, 0.08F, 0.35F, 0.15F},  // epoxy, blue
      {{0.30F, 0.29F, 0.27F}, 0.03F, 0.04F, 0.55F, 0.9F, 0.45F},   // concrete
      {{0.22F, 0.21F, 0.20F}, 0.03F, 0.04F, 0.55F, 0.9F, 0.50F},   // concrete, dark
      {{0.33F, 0.31F, 0.28F}, 0.04F, 0.05F, 0.3F, 0.6F, 0.35F},    // concrete, polished
      {{0.07F, 0.07F, 0.075F}, 0.03F, 0.04F, 0.7F, 0.95F, 0.60F},  // asphalt
  }};
  const Look& look = random.pick(looks);
  const float value = static_cast<float>(random.uniform(0.75, 1.3));
  style.slot_floor = look.colour * value;
  style.aisle_floor = style.slot_floor;
  style.floor_specular = static_cast<float>(random.uniform(look.specular_low, look.specular_high));
  style.floor_roughness =
      static_cast<float>(random.uniform(look.roughness_low, look.roughness_high));
  style.grain = look.grain * random.uniform(0.6, 1.3);
  style.two_tone = random.chance(0.35);
  if (style.two_tone) {
    style.aisle_floor =
        looks[random.index(5)].colour * static_cast<float>(random.uniform(0.7, 1.2));
  }
}

// Who paints lines picks a floor that shows them: light floors under dull white would hide them.
void keepPaintVisible(GarageStyle& style) {
  constexpr float kContrast = 2.3F;
  const auto luminance = [](const Eigen::Vector3f& c) {
    return 0.2126F * c.x() + 0.7152F * c.y() + 0.0722F * c.z();
  };
  const float paint = std::min(luminance(style.line_colour), luminance(style.arrow_colour));
  for (Eigen::Vector3f* floor : {&style.slot_floor, &style.aisle_floor}) {
    *floor *= std::min(1.0F, paint / (kContrast * luminance(*floor)));
  }
}

void drawStructure(GarageStyle& style, Random random) {
  const std::array<Eigen::Vector3f, 7> lower = {{{0.04F, 0.30F, 0.30F},
                                                 {0.05F, 0.20F, 0.45F},
                                                 {0.10F, 0.32F, 0.12F},
                                                 {0.58F, 0.45F, 0.10F},
                                                 {0.45F, 0.10F, 0.07F},
                                                 {0.60F, 0.60F, 0.58F},
                                                 {0.30F, 0.29F, 0.28F}}};
  const float value = static_cast<float>(random.uniform(0.7, 1.2));
  style.wall_lower = (random.pick(lower) * value).cwiseMin(0.8F);
  const float upper = static_cast<float>(random.uniform(0.35, 0.78));
  style.wall_upper = Eigen::Vector3f(upper, upper, upper * 0.97F);
  style.wall_band_height = random.chance(0.7) ? random.uniform(0.9, 2.2) : 0.0;
  const float pillar = static_cast<float>(random.uniform(0.35, 0.78));
  style.pillar_colour = Eigen::Vector3f(pillar, pillar, pillar * 0.97F);
  if (random.chance(0.25)) style.pillar_colour = style.wall_lower;
  const float ceiling = static_cast<float>(random.uniform(0.25, 0.75));
  style.ceiling_colour = Eigen::Vector3f(ceiling, ceiling, ceiling * 0.97F);
  random.shuffle(style.zone_colours);
  style.guard_diagonal = random.chance(0.6);
  style.guard_height = random.chance(0.85) ? random.uniform(0.8, 1.3) : 0.0;
  style.zone_text_height = random.uniform(0.3, 0.5);
  style.zone_text_center = random.uniform(1.5, 1.9);
  style.zone_faces = random.chance(0.6) ? 4 : 2;
  style.zone_scheme = random.integer(0, 3);
  style.zone_band = random.chance(0.75);
  style.guide_share = random.uniform(0.1, 0.7);
  style.limit_sign_share = random.uniform(0.0, 0.15);
  style.zone_share = random.chance(0.6) ? 1.0 : random.uniform(0.4, 1.0);
}

void drawLight(GarageStyle& style, Random random) {
  style.lamp_spacing = random.uniform(5.0, 8.0);
  style.lamps_across = random.chance(0.3);
  style.lamps_in_line = random.chance(0.45);
  style.tray_dark = random.chance(0.6);
  style.lamp_dead_share = random.chance(0.5) ? random.uniform(0.0, 0.25) : 0.0;
  style.lamp_flicker_share = random.chance(0.3) ? random.uniform(0.0, 0.08) : 0.0;
  const float warm = static_cast<float>(random.uniform(-0.5, 1.0));
  style.lamp_colour = Eigen::Vector3f(1.0F + 0.04F * warm, 1.0F, 1.0F - 0.14F * warm);
  style.daylight = random.chance(0.6);
}

}  // namespace

GarageStyle makeStyle(const std::string& name, std::uint64_t seed) {
  GarageStyle style;
  style.zone_colours = zonePalette();
  if (name != "random") {
    style.row_markings = {{3, SlotMarking::kTShaped},
                          {4, SlotMarking::kTShaped},
                          {5, SlotMarking::kLShaped},
                          {9, SlotMarking::kOpen}};
    return style;
  }
  const Random random = Random(seed).fork("style");
  drawSizes(style, random.fork("sizes"));
  drawPaint(style, random.fork("paint"));
  drawFloor(style, random.fork("floor"));
  keepPaintVisible(style);
  drawStructure(style, random.fork("structure"));
  drawLight(style, random.fork("light"));
  return style;
}

}  // namespace parkade::sim
