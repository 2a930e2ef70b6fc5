// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "parkade/core/random.hpp"
#include "parkade/sim/world/floor_surface.hpp"
#include "parkade/sim/world/polygon.hpp"
#include "parkade/sim/world/scene_builder.hpp"
#include "parkade/sim/world/style.hpp"

namespace parkade::sim {
namespace {

/// The ways of wheels: both directions of every aisle.
void addTracks(const Garage& garage, FloorLook& look) {
  for (const AisleGraph::Edge& edge : garage.aisles.edges) {
    const Eigen::Vector2d a = garage.aisles.nodes[static_cast<std::size_t>(edge.from)];
    const Eigen::Vector2d d = garage.aisles.nodes[static_cast<std::size_t>(edge.to)] - a;
    const Frame2 frame{a, std::atan2(d.y(), d.x())};
    for (const double side : {-0.25, 0.25}) {
      look.tyre_tracks.push_back({frame * Eigen::Vector2d(0.0, side * edge.width),
                                  frame * Eigen::Vector2d(d.norm(), side * edge.width)});
    }
  }
}

void addOil(const Garage& garage, Random random, FloorLook& look) {
  for (const Slot& slot : garage.slots) {
    if (!random.chance(0.4)) continue;
    const auto& c = slot.corners;
    const double u = random.uniform(0.35, 0.65);
    const double v = random.uniform(0.55, 0.85);
    look.oil_spots.push_back((1 - v) * ((1 - u) * c[0] + u * c[1]) +
                             v * ((1 - u) * c[3] + u * c[2]));
  }
}

/// Expansion joints under every second pillar line.
void addJoints(const Garage& garage, FloorLook& look) {
  std::set<long> columns;
  std::set<long> rows;
  for (const Pillar& pillar : garage.pillars) {
    columns.insert(std::lround(pillar.center.x() * 1000.0));
    rows.insert(std::lround(pillar.center.y() * 1000.0));
  }
  int i = 0;
  for (const long x : columns) {
    if (i++ % 2 != 0) continue;
    look.joints.push_back({{1e-3 * static_cast<double>(x), garage.min.y()},
                           {1e-3 * static_cast<double>(x), garage.max.y()}});
  }
  i = 0;
  for (const long y : rows) {
    if (i++ % 2 != 0) continue;
    look.joints.push_back({{garage.min.x(), 1e-3 * static_cast<double>(y)},
                           {garage.max.x(), 1e-3 * static_cast<double>(y)}});
  }
}

/// Drain grates along the middle of the cross aisles: dark bars in a frame.
void addDrains(const Garage& garage, Random random, std::vector<FloorPaint>& paints) {
  FloorPaint bars;
  bars.label = SemanticClass::kFloor;
  bars.albedo = Eigen::Vector3f::Constant(0.03F);
  bars.roughness = 0.9F;
  FloorPaint rim = bars;
  rim.albedo = Eigen::Vector3f::Constant(0.18F);
  for (const Eigen::Vector2d& node : garage.aisles.nodes) {
    if (!random.chance(0.6)) continue;
    const Frame2 at{node + Eigen::Vector2d(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5)),
                    0.0};
    rim.polygons.push_back(rectangle(at, -0.25, -0.25, 0.25, 0.25));
    for (int k = -4; k <= 4; ++k) {
      bars.polygons.push_back(rectangle(at, 0.05 * k - 0.014, -0.21, 0.05 * k + 0.014, 0.21));
    }
  }
  paints.push_back(std::move(rim));
  paints.push_back(std::move(bars));
}

/// Markings of one look make one paint: the surface keeps few of them. Each marking is worn as one
/// of a few grades. Fields that other markings lie on come first.
void addMarkings(const Garage& garage, const GarageStyle& style, double wear, Random random,
                 std::vector<FloorPaint>& paints) {
  constexpr std::array<double, 4> kGrades = {0.55, 0.85, 1.1, 1.4};
  using Key = std::tuple<bool, SemanticClass, float, float, float, std::size_t>;
  std::map<Key, FloorPaint> grouped;
  for (const Marking& marking : garage.markings) {
    if (marking.semantic_class == SemanticClass::kSpeedBump ||
        marking.semantic_class == SemanticClass::kWheelStop) {
      continue;  // bodies of their own
    }
    const std::size_t grade = random.index(kGrades.size());
    const bool on_top = marking.meaning != "accessible_field";
    const Eigen::Vector3f& c = marking.colour;
    FloorPaint& paint = grouped[{on_top, marking.semantic_class, c.x(), c.y(), c.z(), grade}];
    paint.polygons.insert(paint.polygons.end(), marking.polygons.begin(), marking.polygons.end());
    paint.label = marking.semantic_class;
    paint.albedo = c;
    paint.wear = std::clamp(style.wear * wear * kGrades[grade], 0.0, 0.95);
    paint.roughness = std::max(0.35F, style.floor_roughness);
  }
  for (auto& entry : grouped) paints.push_back(std::move(entry.second));
}

}  // namespace

std::shared_ptr<const FloorSurface> buildFloor(const Garage& garage, double wear, double dirt) {
  const GarageStyle style = makeStyle(garage.name, garage.seed);
  const Random random = Random(garage.seed).fork("floor");
  FloorLook look;
  look.albedo = style.slot_floor;
  look.specular = style.floor_specular;
  look.roughness = style.floor_roughness;
  look.grain = style.grain;
  look.dirt = std::clamp(style.dirt * dirt, 0.0, 1.0);
  look.seed = random.fork("look").bits();
  if (style.two_tone) {
    FloorLook::Zone& aisles = look.zones.emplace_back();
    aisles.albedo = style.aisle_floor;
    for (const AisleGraph::Edge& edge : garage.aisles.edges) {
      const Eigen::Vector2d a = garage.aisles.nodes[static_cast<std::size_t>(edge.from)];
      const Eigen::Vector2d b = garage.aisles.nodes[static_cast<std::size_t>(edge.to)];
      aisles.outlines.push_back(strip(a, b, edge.width, 0.5 * edge.width));
    }
  }
  std::vector<FloorPaint> paints;
  if (dirt > 0.0) {
    addTracks(garage, look);
    addOil(garage, random.fork("oil"), look);
    addJoints(garage, look);
    addDrains(garage, random.fork("drains"), paints);
  }
  addMarkings(garage, style, wear, random.fork("wear"), paints);
  return makeFloorSurface(garage.min, garage.max, look, paints);
}

}  // namespace parkade::sim
