// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/mapping/parking_map.hpp"

namespace parkade {

struct RowCompletionOptions {
  double fit_m = 0.3;
  double reach_m = 12.0;
  double min_log_odds = 1.0;
  double corner_sigma_m = 0.06;

  void visit(OptionVisitor& v) {
    v.field("fit_m", fit_m, "m",
            "A gap in a row of slots may be this much longer or shorter than the slots that it "
            "holds.",
            0.0, 1.0);
    v.field("reach_m", reach_m, "m", "Rows are followed so far beyond their last slots.", 0.0,
            50.0);
    v.field("min_log_odds", min_log_odds, "log-odds",
            "Slots are told where the layers make them so likely.", -10.0, 100.0);
    v.field("corner_sigma_m", corner_sigma_m, "m",
            "Corners of such slots are known no better than this.", 0.0, 1.0);
  }
};

struct RowCompletion {
  std::vector<MapSlot> added;          ///< with id 0 and no observations, unless only moved
  std::vector<std::int64_t> replaced;  ///< ids of slots told, in their order
};

/// Slots that no picture told and that the map as a whole does: rows of slots are alike, and where
/// a gap between two of them, or between one and a pillar, is as long as one or several more, and
/// the layers show their paint or vehicles in them and nothing that says otherwise, there they are.
/// Readings of another shape that were told there instead, less likely, are replaced. Slots whose
/// entrance lies off their row's line are moved to it (row_alignment.hpp): replaced and added with
/// their id. told: the
/// slots that were observed; objects: pillars. World frame. docs/math/slots.md.
RowCompletion completeRows(const std::vector<MapSlot>& told, const std::vector<MapObject>& objects,
                           const LayeredGrid& grid, const RowCompletionOptions& options = {});

}  // namespace parkade
