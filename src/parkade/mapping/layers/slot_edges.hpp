// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "parkade/mapping/layered_grid.hpp"
#include "parkade/mapping/parking_map.hpp"

// The edges of told slots, and what the layer of parking lines shows of them. Internal to
// slot_lines.hpp.

namespace parkade {

enum class SlotEdgeKind : std::uint8_t { kSide, kFront, kRear };

/// An edge of a slot, in bins of 0.25 m from the entrance or the nearer corner.
struct SlotEdge {
  struct Bin {
    bool seen = false;
    bool shows = false;  ///< a line
  };
  static constexpr double kBin = 0.25;    ///< m
  static constexpr double kAcross = 0.2;  ///< m to either side, within which its line lies
  static constexpr double kCorner = 0.2;  ///< m from its ends, where other lines cross it
  static constexpr double kBar = 0.5;     ///< m from corners, where a T or an L has its bar

  Eigen::Vector2d from;  ///< sides: at the entrance
  Eigen::Vector2d to;
  SlotEdgeKind kind;
  SlotShape shape;
  std::vector<Bin> bins;

  [[nodiscard]] double length() const { return (to - from).norm(); }
  [[nodiscard]] double margin() const { return kind == SlotEdgeKind::kSide ? kCorner : kBar; }
  [[nodiscard]] Eigen::Vector2d along() const { return (to - from).normalized(); }
  [[nodiscard]] Eigen::Vector2d across() const { return {-along().y(), along().x()}; }
  /// Lines across begin at both of its corners alike.
  [[nodiscard]] double distance(double s) const {
    return kind == SlotEdgeKind::kSide ? s : std::min(s, length() - s);
  }
  [[nodiscard]] std::size_t binOf(double s) const {
    return static_cast<std::size_t>(std::max(0.0, distance(s)) / kBin);
  }
  [[nodiscard]] int seenBins() const {
    return static_cast<int>(
        std::count_if(bins.begin(), bins.end(), [](const Bin& bin) { return bin.seen; }));
  }
  [[nodiscard]] bool isSeen() const { return seenBins() >= 2; }
  /// Whether it shows a line in a quarter of what is seen of it.
  [[nodiscard]] bool isPainted() const {
    constexpr double kSome = 0.25;
    const auto shows =
        std::count_if(bins.begin(), bins.end(), [](const Bin& bin) { return bin.shows; });
    return static_cast<double>(shows) >= kSome * seenBins();
  }
};

/// Whether the layer of parking lines believes in a slot's line at a place.
bool showsSlotLine(const LayeredGrid& grid, const Eigen::Vector2d& p);

/// The edges of all slots, each once, moved onto the straight line that the layer holds beside it,
/// with their bins judged.
std::vector<SlotEdge> slotEdges(const std::vector<MapSlot>& slots, const LayeredGrid& grid);

/// Entrances, or rears, in rows: of slots of a shape that are as wide, on one line, with at most a
/// pillar between two.
std::vector<std::vector<const SlotEdge*>> rowsOfEdges(const std::vector<const SlotEdge*>& edges);

}  // namespace parkade
