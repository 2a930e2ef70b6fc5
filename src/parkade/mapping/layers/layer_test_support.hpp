// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/mapping/layered_grid.hpp"

// Layers drawn by hand, for tests.

namespace parkade::testing {

/// Makes a rectangle of a layer that class, whatever it was.
template <GridLayer kLayer>
void fillLayer(LayeredGrid& grid, SemanticClass c, const Eigen::Vector2d& min,
               const Eigen::Vector2d& max) {
  for (double x = min.x() + 0.025; x < max.x(); x += 0.05) {
    for (double y = min.y() + 0.025; y < max.y(); y += 0.05) {
      grid.set(kLayer, grid.cellOf({x, y}), c, 3.0F);
    }
  }
}

/// What a layer holds at a point, doubted or not.
template <GridLayer kLayer>
SemanticClass classAt(const LayeredGrid& grid, double x, double y) {
  return grid.at(kLayer, grid.cellOf({x, y})).semantic_class;
}

}  // namespace parkade::testing
