// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <set>
#include <utility>
#include <vector>

#include "parkade/mapping/slots/row_completion.hpp"

namespace parkade::testing {

using Eigen::Vector2d;

inline constexpr double kWidth = 2.5;
inline constexpr double kDepth = 5.0;
inline constexpr double kMargin = 0.5;  // m from a pillar's middle to the next slot
inline constexpr double kBay = 3 * kWidth + 2 * kMargin;

// A row along x whose slots are entered from below: bays of three between pillars at 0, kBay, ...
// The floor all around has been seen.
class Garage {
 public:
  explicit Garage(double seen_to = 9.0) {
    fill(GridLayer::kParkingLines, SemanticClass::kFloor, {-12.0, -4.0}, {36.0, seen_to});
    fill(GridLayer::kAvailability, SemanticClass::kFloor, {-12.0, -4.0}, {36.0, seen_to});
    for (int bay = 0; bay < 4; ++bay) {
      MapObject pillar;
      pillar.id = bay;
      pillar.semantic_class = SemanticClass::kPillar;
      pillar.position = {bay * kBay, 1.2, 0.0};
      pillar.observations = 40;
      objects.push_back(pillar);
    }
  }

  static MapSlot slotAt(int bay, int place) {
    const double x = bay * kBay + kMargin + place * kWidth;
    MapSlot slot;
    slot.id = 10 * bay + place + 1;
    slot.corners = {Vector2d(x, 0.0), Vector2d(x + kWidth, 0.0), Vector2d(x + kWidth, kDepth),
                    Vector2d(x, kDepth)};
    slot.corner_sigma = 0.02;
    slot.observations = 20;
    slot.last_seen_ns = 5;
    return slot;
  }
  void tell(int bay, std::set<int> places) {
    for (const int place : places) told.push_back(slotAt(bay, place));
  }
  // Paints both sides and the entrance of a slot.
  void paint(const MapSlot& slot) {
    const auto& c = slot.corners;
    for (const auto& [from, to] : {std::pair{c[0], c[3]}, {c[1], c[2]}, {c[0], c[1]}}) {
      const int count = static_cast<int>((to - from).norm() / 0.02);
      for (int i = 0; i <= count; ++i) {
        const Vector2d p = from + (to - from) * i / count;
        set(GridLayer::kParkingLines, SemanticClass::kSlotLine, p);
      }
    }
  }
  // A line of 0.1 m along y.
  void paintUpright(const Vector2d& from, const Vector2d& to) {
    const Vector2d half_width(0.05, 0.0);
    fill(GridLayer::kParkingLines, SemanticClass::kSlotLine, from.cwiseMin(to) - half_width,
         from.cwiseMax(to) + half_width);
  }
  void park(const MapSlot& slot) {
    const Vector2d inset(0.3, 0.4);
    fill(GridLayer::kAvailability, SemanticClass::kVehicle,
         slot.corners[0].cwiseMin(slot.corners[2]) + inset,
         slot.corners[0].cwiseMax(slot.corners[2]) - inset);
  }
  void number(const MapSlot& slot) {
    fill(GridLayer::kRoadMarkers, SemanticClass::kPaintedNumber,
         slot.corners[0] + Vector2d(1.0, 1.0), slot.corners[0] + Vector2d(1.4, 1.2));
  }
  void stop(const MapSlot& slot) {
    const Vector2d at = slot.corners[0] + 0.85 * (slot.corners[3] - slot.corners[0]);
    const Vector2d across = slot.corners[1] - slot.corners[0];
    const Vector2d a = at + 0.2 * across;
    const Vector2d b = at + 0.8 * across;
    fill(GridLayer::kRoadMarkers, SemanticClass::kWheelStop, a.cwiseMin(b) - Vector2d(0.0, 0.08),
         a.cwiseMax(b) + Vector2d(0.0, 0.08));
  }
  // A square sign about the middle of a slot.
  void sign(const Vector2d& middle) {
    fill(GridLayer::kRoadMarkers, SemanticClass::kPaintedNumber, middle - Vector2d(0.75, 0.75),
         middle + Vector2d(0.75, 0.75));
  }
  void paintTold() {
    for (const MapSlot& slot : told) paint(slot);
  }
  void fill(GridLayer layer, SemanticClass c, const Vector2d& min, const Vector2d& max) {
    for (double x = min.x(); x < max.x(); x += 0.05) {
      for (double y = min.y(); y < max.y(); y += 0.05) set(layer, c, {x + 0.01, y + 0.01});
    }
  }
  [[nodiscard]] RowCompletion complete() const { return completeRows(told, objects, grid); }

  std::vector<MapSlot> told;
  std::vector<MapObject> objects;
  LayeredGrid grid;

 private:
  void set(GridLayer layer, SemanticClass c, const Vector2d& p) {
    GridCell& cell = grid.touch(layer, grid.cellOf(p));
    cell.semantic_class = c;
    cell.log_odds = 40;
  }
};

inline void expectAt(const MapSlot& slot, const MapSlot& expected) {
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT((slot.corners[k] - expected.corners[k]).norm(), 0.02) << "corner " << k;
  }
}

}  // namespace parkade::testing
