// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "parkade/mapping/objects/arrow_templates.hpp"

// Inside of painted_arrows.hpp: the looks of arrows, searched for in paint.

namespace parkade {

/// An arrow that may be there.
struct FoundArrow {
  const ArrowTemplate* look = nullptr;
  std::string meaning;  ///< empty: paint leaves it open
  SE2 pose;             ///< T_map_arrow
  double score = 0.0;   ///< log-likelihood ratio against bare floor
};

/// How an arrow and the paint around it agree.
struct ArrowFit {
  double seen = 0.0;       ///< share of its paint that the map knows
  double shown = 0.0;      ///< share of that where the map shows paint
  double explained = 0.0;  ///< share of the paint around that is its own, to 0.1 m

  [[nodiscard]] bool isGood() const { return shown > 0.3 && explained > 0.8; }
};
/// paint: middles of the cells of arrows' paint around it.
ArrowFit fitOf(const FoundArrow& arrow, const PaintRaster& raster,
               const std::vector<Eigen::Vector2d>& paint);

/// The arrow that a patch of paint is, if there is one that is likely enough and plainly likelier
/// than others. Arrows lie along the garage's axes: axis, rad, is the direction of one.
std::optional<FoundArrow> findArrow(const std::vector<Eigen::Vector2d>& patch,
                                    const PaintRaster& raster,
                                    const std::map<std::string, ArrowTemplate>& looks, double axis);

}  // namespace parkade
