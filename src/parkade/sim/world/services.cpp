// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "parkade/sim/world/structure.hpp"

namespace parkade::sim {
namespace {

constexpr double kTubeLength = 1.2;  // m
constexpr double kTubeDrop = 0.36;   // of the tube's middle below the ceiling, m
constexpr float kTubeGlow = 40.0F;   // luminance of a tube per lux on the floor
constexpr float kFlux = 3200.0F;     // lm; the light is scaled to the asked illuminance

/// An aisle of the graph as a frame along it.
struct ServiceRun {
  Frame2 frame;
  double length = 0.0;
  double width = 0.0;
};

std::vector<ServiceRun> runsOf(const Garage& garage) {
  std::vector<ServiceRun> runs;
  for (const AisleGraph::Edge& edge : garage.aisles.edges) {
    const Eigen::Vector2d a = garage.aisles.nodes[static_cast<std::size_t>(edge.from)];
    const Eigen::Vector2d d = garage.aisles.nodes[static_cast<std::size_t>(edge.to)] - a;
    runs.push_back({{a, std::atan2(d.y(), d.x())}, d.norm(), edge.width});
  }
  return runs;
}

/// A box along a run, centred at (s, y, z).
void boxAlong(const ServiceRun& run, double s, double y, double z, double half_length,
              double half_width, double half_height, std::uint16_t material, MeshBuilder& mesh) {
  mesh.box(point3(run.frame * Eigen::Vector2d(s, y), z),
           {static_cast<float>(half_length), static_cast<float>(half_width),
            static_cast<float>(half_height)},
           material, static_cast<float>(run.frame.heading));
}

void pipeAlong(const ServiceRun& run, double y, double z, double radius, std::uint16_t material,
               MeshBuilder& mesh) {
  mesh.cone(point3(run.frame * Eigen::Vector2d(-0.5, y), z),
            point3(run.frame * Eigen::Vector2d(run.length + 0.5, y), z), static_cast<float>(radius),
            static_cast<float>(radius), 10, material, false);
}

void addDuct(const ServiceRun& run, double ceiling, std::uint16_t metal, std::uint16_t dark,
             MeshBuilder& mesh) {
  const double y = 0.5 * run.width + 1.2;
  const double z = ceiling - 0.24 - 0.19;
  boxAlong(run, 0.5 * run.length, y, z, 0.5 * run.length - 0.5, 0.45, 0.18, metal, mesh);
  for (double s = 2.0; s < run.length - 1.0; s += 4.5) {
    boxAlong(run, s, y, z, 0.03, 0.47, 0.195, dark, mesh);             // flanges
    boxAlong(run, s + 2.0, y - 0.46, z, 0.3, 0.012, 0.1, dark, mesh);  // air outlets
  }
}

void addSprinklers(const ServiceRun& run, double ceiling, std::uint16_t red, MeshBuilder& mesh) {
  const double y = -1.35;
  const double z = ceiling - 0.30;
  pipeAlong(run, y, z, 0.045, red, mesh);
  for (double s = 1.5; s < run.length; s += 3.2) {
    mesh.cone(point3(run.frame * Eigen::Vector2d(s, -0.5 * run.width - 2.0), z + 0.03),
              point3(run.frame * Eigen::Vector2d(s, 0.5 * run.width + 2.0), z + 0.03), 0.018F,
              0.018F, 6, red, false);
    mesh.cone(point3(run.frame * Eigen::Vector2d(s, y), z),
              point3(run.frame * Eigen::Vector2d(s, y), z - 0.12), 0.015F, 0.03F, 6, red, true);
  }
}

void addTray(const ServiceRun& run, double ceiling, double y0, std::uint16_t metal,
             MeshBuilder& mesh) {
  boxAlong(run, 0.5 * run.length, y0, ceiling - 0.29, 0.5 * run.length, 0.11, 0.025, metal, mesh);
  for (double s = 1.0; s < run.length; s += 2.5) {
    for (const double y : {-0.1, 0.1}) {
      boxAlong(run, s, y0 + y, ceiling - 0.15, 0.008, 0.008, 0.15, metal, mesh);
    }
  }
}

/// One tube with its housing; lit tubes light the scene.
void addTube(const Frame2& at, double ceiling, bool lit, bool flickers, const GarageStyle& style,
             const std::array<std::uint16_t, 3>& materials, Random& random, Palette& palette,
             MeshBuilder& mesh) {
  const double z = ceiling - kTubeDrop;
  const float yaw = static_cast<float>(at.heading);
  const float half = static_cast<float>(0.5 * kTubeLength);
  mesh.box(point3(at.origin, z + 0.035), {half + 0.02F, 0.05F, 0.014F}, materials[0], yaw);
  mesh.box(point3(at.origin, z), {half, 0.028F, 0.02F}, lit ? materials[1] : materials[2], yaw);
  if (!lit) return;
  Luminaire lamp;
  const Eigen::Vector2d reach(0.5 * kTubeLength, 0.0);
  lamp.end_a = point3(at * (-reach), z - 0.025);
  lamp.end_b = point3(at * reach, z - 0.025);
  lamp.flux_lm = kFlux;
  lamp.colour = style.lamp_colour;
  if (flickers) {
    lamp.flicker_hz = static_cast<float>(random.uniform(2.0, 9.0));
    lamp.flicker_depth = static_cast<float>(random.uniform(0.4, 1.0));
  }
  palette.scene().luminaires.push_back(lamp);
}

}  // namespace

void addServices(const Garage& garage, const GarageStyle& style, Random random, Palette& palette,
                 MeshBuilder& mesh) {
  const std::uint16_t metal =
      palette.add("duct", SemanticClass::kCeiling, Eigen::Vector3f::Constant(0.52F), 0.8F, 0.1F);
  const std::uint16_t dark =
      palette.add("duct_dark", SemanticClass::kCeiling, Eigen::Vector3f::Constant(0.12F));
  const std::uint16_t red =
      palette.add("pipe_red", SemanticClass::kCeiling, {0.42F, 0.04F, 0.03F}, 0.5F);
  const std::uint16_t white =
      palette.add("pipe_white", SemanticClass::kCeiling, 1.1F * style.ceiling_colour, 0.6F);
  const std::uint16_t bottle =
      palette.add("extinguisher", SemanticClass::kPillar, {0.50F, 0.02F, 0.02F}, 0.35F);
  for (const ServiceRun& run : runsOf(garage)) {
    for (const double y : {-0.25, 0.0, 0.25}) {
      if (style.lamps_in_line != (y == 0.0)) continue;
      addTray(run, garage.ceiling_height, y * run.width, style.tray_dark ? dark : white, mesh);
    }
    const double u = random.uniform();
    if (u < 0.45) addDuct(run, garage.ceiling_height, metal, dark, mesh);
    if (u > 0.3) addSprinklers(run, garage.ceiling_height, red, mesh);
    const double y = 0.5 * run.width + random.uniform(-1.0, 0.4);
    if (random.chance(0.7)) {
      pipeAlong(run, -y, garage.ceiling_height - 0.34, 0.06, white, mesh);
      pipeAlong(run, -y - 0.2, garage.ceiling_height - 0.33, 0.04, white, mesh);
    }
    if (random.chance(0.5)) {  // a camera's dome
      const double s = random.uniform(2.0, std::max(2.5, run.length - 2.0));
      mesh.ellipsoid(point3(run.frame * Eigen::Vector2d(s, 1.0), garage.ceiling_height - 0.42),
                     {0.08F, 0.08F, 0.08F}, 6, 10, dark);
      boxAlong(run, s, 1.0, garage.ceiling_height - 0.2, 0.015, 0.015, 0.2, white, mesh);
    }
  }
  for (const Pillar& pillar : garage.pillars) {
    if (!random.chance(0.1)) continue;
    const double out = 0.5 * pillar.size.x() + 0.1;
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    const Eigen::Vector2d p = pillar.center + Eigen::Vector2d(side * out, 0.0);
    const double z = garage.floorHeight(p) + 0.35;
    mesh.cone(point3(p, z), point3(p, z + 0.45), 0.07F, 0.07F, 12, bottle);
    mesh.cone(point3(p, z + 0.45), point3(p, z + 0.55), 0.06F, 0.02F, 12, bottle);
  }
}

void addLamps(const Garage& garage, const GarageStyle& style, Random random, Palette& palette,
              MeshBuilder& mesh) {
  const std::array<std::uint16_t, 3> materials = {
      palette.add("lamp_housing", SemanticClass::kCeiling, Eigen::Vector3f::Constant(0.7F), 0.5F),
      palette.addGlow("tube", SemanticClass::kCeiling, kTubeGlow * style.lamp_colour),
      palette.add("tube_dark", SemanticClass::kCeiling, Eigen::Vector3f::Constant(0.65F), 0.4F)};
  const auto place = [&](const Frame2& at) {
    const bool lit = !random.chance(style.lamp_dead_share);
    const bool flickers = random.chance(style.lamp_flicker_share);
    addTube(at, garage.ceiling_height, lit, flickers, style, materials, random, palette, mesh);
  };
  for (const ServiceRun& run : runsOf(garage)) {
    const int count = std::max(1, static_cast<int>(std::lround(run.length / style.lamp_spacing)));
    // Over both lanes, staggered: even light without glare on every tube.
    for (int i = 0; i < 2 * count; ++i) {
      const double s = run.length * (i + 0.5) / (2 * count);
      const double y = style.lamps_in_line ? 0.0 : (i % 2 == 0 ? 0.25 : -0.25) * run.width;
      if (style.lamps_in_line && i % 2 == 1) continue;
      place({run.frame * Eigen::Vector2d(s, y),
             run.frame.heading + (style.lamps_across ? M_PI_2 : 0.0)});
    }
  }
  // Some over the slots.
  for (std::size_t i = 1; i < garage.slots.size(); i += style.lamps_in_line ? 6 : 3) {
    const auto& c = garage.slots[i].corners;
    const Eigen::Vector2d front = c[1] - c[0];
    place({0.25 * (c[0] + c[1] + c[2] + c[3]), std::atan2(front.y(), front.x())});
  }
  if (palette.scene().luminaires.empty()) {  // never quite dark
    addTube({garage.aisles.nodes.front(), 0.0}, garage.ceiling_height, true, false, style,
            materials, random, palette, mesh);
  }
}

}  // namespace parkade::sim
