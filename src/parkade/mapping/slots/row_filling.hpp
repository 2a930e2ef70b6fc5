// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/mapping/layered_grid.hpp"
#include "parkade/mapping/parking_map.hpp"
#include "parkade/mapping/slots/row_completion.hpp"
#include "parkade/mapping/slots/row_evidence.hpp"
#include "parkade/mapping/slots/row_pattern.hpp"
#include "parkade/mapping/slots/slot_likelihood.hpp"

// Inside of the row completion: slots that would fill the gaps of rows.

namespace parkade::slot_rows {

/// A slot that nobody saw, and what the layers hold of it, by which it is free or not.
struct Place {
  MapSlot slot;
  SlotEvidence evidence;
};

/// From begin to end along a row of `told`, like its nearest slot seen last; corners known to sigma
/// (m) at best.
Place placeAt(const Row& row, const Pattern& pattern, double begin, double end,
              const std::vector<MapSlot>& told, const LayeredGrid& grid, double sigma);

struct Filling {
  std::vector<MapSlot> slots;  ///< from left to right
  double log_odds = 0.0;       ///< for all of them being there
  double merit = 0.0;          ///< the same, with the lines that known slots have as well
};

/// The likely fillings (min_log_odds) of all gaps in the rows of the slots told, whatever lies on
/// them; pillars: their middles.
std::vector<Filling> findFillings(const std::vector<MapSlot>& told,
                                  const std::vector<Eigen::Vector2d>& pillars,
                                  const LayeredGrid& grid, const SlotLikelihood& likelihood,
                                  const RowCompletionOptions& options);

}  // namespace parkade::slot_rows
