// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/layered_grid.hpp"
#include "parkade/mapping/objects/paint_raster.hpp"

// Inside of painted_crossings.hpp: the stripes of one crossing.

namespace parkade {

/// Stripes as wide and as far from one another: along x of their frame, one behind the other along
/// y. docs/math/grid.md.
struct CrossingStripes {
  struct Span {
    double low = 0.0;
    double high = 0.0;
  };
  SE2 T_map_crossing;
  double period = 0.0;    ///< m
  double width = 0.0;     ///< m, of a stripe
  double first = 0.0;     ///< y where the stripe of index 0 begins
  double contrast = 0.0;  ///< share of paint on the stripes, less that between them
  Span along;             ///< x
  int from = 0;           ///< indices of the outermost
  int to = -1;
  bool has_ends = false;  ///< bare floor, a car or a wall ends it on both sides, by a stripe more

  [[nodiscard]] int count() const { return to - from + 1; }
  [[nodiscard]] double begin(int index) const { return first + index * period; }
  [[nodiscard]] Span across() const { return {begin(from), begin(to) + width}; }
  /// Whether one holds a place of its frame, and not only at its rim.
  [[nodiscard]] bool holds(const Eigen::Vector2d& p) const;
  /// In the map, counter-clockwise.
  [[nodiscard]] std::vector<Eigen::Vector2d> outline() const;
};

/// The stripes that a patch of a crossing's paint (middles of cells) shows, three at least; nothing
/// where it shows none. axis: rad, an axis of the garage, which stripes lie along or across.
std::optional<CrossingStripes> fitStripes(const std::vector<Eigen::Vector2d>& patch,
                                          const PaintRaster& raster, const LayeredGrid& grid,
                                          double axis);

}  // namespace parkade
