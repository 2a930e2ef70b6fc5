// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace parkade::sim {

/// The exact share of each cell of a grid that a polygon covers, of its bounding box only.
struct Coverage {
  int x0 = 0;  ///< first cell along x
  int y0 = 0;
  int width = 0;
  int height = 0;
  std::vector<float> share;  ///< row by row, 0 to 1

  [[nodiscard]] float at(int x, int y) const {
    return share[static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(x - x0)];
  }
};

/// Any simple polygon, in units of cells: cell (x, y) covers [x, x + 1) x [y, y + 1). The direction
/// of the outline does not matter. By signed areas accumulated along rows.
Coverage coverageOf(const std::vector<Eigen::Vector2d>& polygon);

}  // namespace parkade::sim
