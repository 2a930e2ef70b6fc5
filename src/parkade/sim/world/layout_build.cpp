// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// The bare garage that a layout makes: slots, pillars, aisles.
#include <algorithm>
#include <cmath>

#include "parkade/sim/world/layout.hpp"

namespace parkade::sim {
namespace {

Slot makeSlot(const Frame2& front, double x0, double x1, const Eigen::Vector2d& into, SlotType type,
              SlotMarking marking) {
  Slot slot;
  slot.type = type;
  slot.marking = marking;
  slot.corners = {front * Eigen::Vector2d(x0, 0.0), front * Eigen::Vector2d(x1, 0.0),
                  front * (Eigen::Vector2d(x1, 0.0) + into),
                  front * (Eigen::Vector2d(x0, 0.0) + into)};
  return slot;
}

std::vector<Slot> slotsOfBay(const Row& row, const Bay& bay, const GarageStyle& style) {
  const double gap = pillarGap(style);
  double width = style.slot_width;  // along the front
  double lean = 0.0;                // room for a slanted slot's shift beside the pillar
  Eigen::Vector2d into(0.0, std::min(style.slot_length, row.depth - 0.1));
  SlotType type = SlotType::kPerpendicular;
  SlotMarking marking = style.marking;
  switch (bay.kind) {
    case BayKind::kPerpendicular:
      break;
    case BayKind::kAccessible:
      width = style.accessible_width;
      marking = SlotMarking::kClosed;
      break;
    case BayKind::kParallel:
      type = SlotType::kParallel;
      width = style.parallel_length;
      into.y() = style.parallel_width;
      break;
    case BayKind::kSlanted: {
      type = SlotType::kSlanted;
      width = style.slot_width / std::sin(style.slant);
      into = style.slot_length * Eigen::Vector2d(std::cos(style.slant), std::sin(style.slant));
      lean = (style.pillar_setback + 0.5 * style.pillar_size) / std::tan(style.slant);
      break;
    }
    default:
      return {};
  }
  const double free = bay.length - gap - lean;
  const int count = static_cast<int>(std::floor(free / width + 1e-9));
  const double start = bay.start + 0.5 * gap + 0.5 * (free - count * width);
  std::vector<Slot> slots;
  for (int i = 0; i < count; ++i) {
    const double x0 = start + i * width;
    slots.push_back(makeSlot(row.front, x0, x0 + width, into, type, marking));
  }
  return slots;
}

Polygon polygonOf(const Slot& slot) {
  return {slot.corners.begin(), slot.corners.end()};
}

Polygon polygonOf(const Room& room) {
  return rectangle({}, room.min.x(), room.min.y(), room.max.x(), room.max.y());
}

Polygon polygonOf(const Pillar& pillar) {
  return rectangle({pillar.center, 0.0}, -0.5 * pillar.size.x(), -0.5 * pillar.size.y(),
                   0.5 * pillar.size.x(), 0.5 * pillar.size.y());
}

bool isFree(const Slot& slot, const Layout& layout, const Garage& garage) {
  const Polygon polygon = polygonOf(slot);
  const auto clash = [&](const Polygon& other) { return convexOverlap(polygon, other, 1e-3); };
  for (const Eigen::Vector2d& p : polygon) {
    if (p.x() < layout.min.x() || p.y() < layout.min.y() || p.x() > layout.max.x() ||
        p.y() > layout.max.y()) {
      return false;
    }
  }
  const auto clashes = [&](const auto& item) { return clash(polygonOf(item)); };
  return std::none_of(garage.pillars.begin(), garage.pillars.end(), clashes) &&
         std::none_of(garage.rooms.begin(), garage.rooms.end(), clashes) &&
         std::none_of(garage.slots.begin(), garage.slots.end(), clashes) &&
         std::none_of(layout.aisles.begin(), layout.aisles.end(), [&](const AisleStrip& aisle) {
           return clash(strip(aisle.a, aisle.b, aisle.width));
         });
}

void addPillars(const Layout& layout, const GarageStyle& style, Garage& garage) {
  for (const double y : layout.pillar_y) {
    for (const double x : layout.pillar_x) {
      Pillar pillar;
      pillar.center = {x, y};
      pillar.size.setConstant(style.pillar_size);
      pillar.height = style.ceiling_height;
      pillar.round = style.round_pillars;
      const bool hidden =
          std::any_of(layout.rooms.begin(), layout.rooms.end(), [&](const Room& room) {
            return convexOverlap(polygonOf(pillar), polygonOf(room), 1e-3);
          });
      if (hidden) continue;
      pillar.id = static_cast<int>(garage.pillars.size()) + 1;
      garage.pillars.push_back(pillar);
    }
  }
}

void addAisleGraph(const Layout& layout, const GarageStyle& style, AisleGraph& graph) {
  const int columns = static_cast<int>(layout.cross_x.size());
  const double limit = style.limit_kmh / 3.6;
  const auto connect = [&](int from, int to) {
    graph.edges.push_back({from, to, style.aisle_width, false, limit});
  };
  for (std::size_t i = 0; i < layout.long_y.size(); ++i) {
    for (int j = 0; j < columns; ++j) {
      const int node = static_cast<int>(graph.nodes.size());
      graph.nodes.emplace_back(layout.cross_x[static_cast<std::size_t>(j)], layout.long_y[i]);
      if (j > 0) connect(node - 1, node);
      if (i > 0) connect(node - columns, node);
    }
  }
}

}  // namespace

void buildFromLayout(const Layout& layout, const GarageStyle& style, Garage& garage) {
  // Owners repaint row by row: some rows carry another kind of lines.
  std::size_t row_index = 0;
  garage.min = layout.min;
  garage.max = layout.max;
  garage.outline = rectangle({}, layout.min.x(), layout.min.y(), layout.max.x(), layout.max.y());
  garage.ceiling_height = style.ceiling_height;
  garage.line_width = style.line_width;
  garage.rooms = layout.rooms;
  garage.entrances = layout.entrances;
  addPillars(layout, style, garage);
  for (const Row& row : layout.rows) {
    const auto other = style.row_markings.find(static_cast<int>(row_index++));
    for (const Bay& bay : row.bays) {
      for (Slot& slot : slotsOfBay(row, bay, style)) {
        if (other != style.row_markings.end() && bay.kind != BayKind::kAccessible) {
          slot.marking = other->second;
        }
        if (!isFree(slot, layout, garage)) continue;
        slot.id = static_cast<int>(garage.slots.size()) + 1;
        garage.slots.push_back(std::move(slot));
      }
    }
  }
  addAisleGraph(layout, style, garage.aisles);
}

}  // namespace parkade::sim
