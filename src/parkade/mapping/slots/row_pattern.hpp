// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "parkade/mapping/parking_map.hpp"
#include "parkade/mapping/slots/slot_row.hpp"

// Inside of the row completion: what the slots of a row look like, and the gaps between them.

namespace parkade::slot_rows {

/// m, of wide slots, as for wheelchairs: 3.5 by DIN 18040-1.
inline constexpr double kLeastWideFront = 3.2;
inline constexpr double kMostWideFront = 4.0;

/// Room that slots leave beside pillars.
struct Margin {
  double length = 0.0;  ///< m
  int seen = 0;         ///< how often, within a hand's breadth
};

/// What slots of one shape look like in a row: medians over its members.
struct Pattern {
  SlotShape shape = SlotShape::kPerpendicular;
  double front = 0.0;                              ///< m between entrance corners
  Eigen::Vector2d side = Eigen::Vector2d::Zero();  ///< from an entrance corner to the rear one
  bool of_row = true;                              ///< or of other rows of the garage
  bool is_wide = false;                            ///< much wider than the garage's others
  /// m from a pillar's middle to the slot that begins after it, and from a slot's end to the pillar
  /// after it. Where slots are slanted they differ.
  std::vector<Margin> before;
  std::vector<Margin> after;
};

/// A slot of this pattern that nobody saw, between two entrance corners; when it was seen last and
/// how well its corners are known (at best sigma, m) are those of the slot `near` it.
MapSlot unseenSlot(const Pattern& pattern, const Eigen::Vector2d& left,
                   const Eigen::Vector2d& right, const MapSlot& near, double sigma);

/// Where p lies along the row, seen along the sides of its slots.
double alongRow(const Row& row, const Pattern& pattern, const Eigen::Vector2d& p);

/// How deep p lies behind the entrances, as a share of the slots' depth.
double depthShare(const Row& row, const Pattern& pattern, const Eigen::Vector2d& p);

/// Whether a pillar stands in a row's depth, or a little in front.
bool standsIn(const Row& row, const Pattern& pattern, const Eigen::Vector2d& p);

enum class GapEnd : std::uint8_t { kSlot, kPillar, kOpen };

/// A stretch of a row without slots, from a slot's corner or a pillar's middle to the next. Where
/// an end is open nothing is known beyond it.
struct Gap {
  double begin = 0.0;
  double end = 0.0;
  GapEnd at_begin = GapEnd::kSlot;
  GapEnd at_end = GapEnd::kSlot;
};

/// For each row the patterns of its shapes, most members first, then those that other rows hold and
/// that could stand in this one (slanted slots lean their own way). Their margins are those of all
/// rows with that shape, or of any if there are none.
std::vector<std::vector<Pattern>> findPatterns(const std::vector<Row>& rows,
                                               const std::vector<MapSlot>& slots,
                                               const std::vector<Eigen::Vector2d>& pillars);

/// The gaps in a row for slots of this pattern, between members and pillars that stand in the row
/// up to reach (m) beyond its ends; the first and the last one are open.
std::vector<Gap> findGaps(const Row& row, const Pattern& pattern,
                          const std::vector<Eigen::Vector2d>& pillars, double reach);

}  // namespace parkade::slot_rows
