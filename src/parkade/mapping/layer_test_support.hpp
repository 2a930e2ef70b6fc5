// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/mapping/layered_grid.hpp"

// Layers drawn by hand, for tests.

namespace parkade::testing {

/// Makes a rectangle of a layer that class, whatever it was.
inline void fillLayer(LayeredGrid& grid, GridLayer layer, SemanticClass c,
                      const Eigen::Vector2d& min, const Eigen::Vector2d& max) {
  for (double x = min.x() + 0.025; x < max.x(); x += 0.05) {
    for (double y = min.y() + 0.025; y < max.y(); y += 0.05) {
      GridCell& cell = grid.touch(layer, grid.cellOf({x, y}));
      cell = GridCell();
      addEvidence(cell, c, 3.0F);
    }
  }
}

/// What a layer holds at a point, doubted or not.
inline SemanticClass classAt(const LayeredGrid& grid, GridLayer layer, double x, double y) {
  return grid.at(layer, grid.cellOf({x, y})).semantic_class;
}

}  // namespace parkade::testing
