// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/marking_box.hpp"

#include <limits>

#include "parkade/geometry/se2.hpp"

namespace parkade::cli {

Eigen::Vector2d middleOf(const sim::Marking& marking,
                         const std::vector<std::vector<Eigen::Vector2d>>& polygons) {
  const SE2 T_garage_marking(marking.heading, marking.position);
  const SE2 T_marking_garage = T_garage_marking.inverse();
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector2d high = -low;
  for (const auto& polygon : polygons) {
    for (const Eigen::Vector2d& p : polygon) {
      low = low.cwiseMin(T_marking_garage * p);
      high = high.cwiseMax(T_marking_garage * p);
    }
  }
  Eigen::Vector2d middle = 0.5 * (low + high);
  if (marking.semantic_class == SemanticClass::kArrow) middle.y() = 0.0;
  return T_garage_marking * middle;
}

}  // namespace parkade::cli
