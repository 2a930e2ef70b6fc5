// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/floor_before.hpp"

namespace parkade::slot_rows {

double floorBefore(const LayeredGrid& grid, const Eigen::Vector2d& left,
                   const Eigen::Vector2d& right, const Eigen::Vector2d& middle) {
  constexpr int kSteps = 10;
  constexpr double kReach = 2.5;  // m
  const Eigen::Vector2d out = (0.5 * (left + right) - middle).normalized();
  int floor = 0;
  for (int i = 1; i < kSteps; ++i) {
    for (int k = 1; k <= kSteps; ++k) {
      const Eigen::Vector2d p = left + (right - left) * i / kSteps + out * kReach * k / kSteps;
      const GridCell cell = grid.at(GridLayer::kParkingLines, grid.cellOf(p));
      floor += cell.known() && cell.semantic_class == SemanticClass::kFloor ? 1 : 0;
    }
  }
  return static_cast<double>(floor) / ((kSteps - 1) * kSteps);
}

}  // namespace parkade::slot_rows
