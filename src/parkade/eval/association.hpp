// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "parkade/core/options.hpp"
#include "parkade/core/result.hpp"
#include "parkade/types/trajectory.hpp"

namespace parkade {

struct AssociationOptions {
  double tolerance_s = 0.01;
  double offset_s = 0.0;
  bool interpolate = false;
  double max_gap_s = 0.5;

  void visit(OptionVisitor& v) {
    v.field("tolerance_s", tolerance_s, "s", "Largest difference of two stamps that match.", 0.0);
    v.field("offset_s", offset_s, "s", "Added to the estimate's stamps before matching.");
    v.field("interpolate", interpolate,
            "Interpolate the reference at the estimate's stamps instead of taking the nearest.");
    v.field("max_gap_s", max_gap_s, "s",
            "A longer pause between poses, which is also longer than three median steps, is a "
            "hole: not covered, and not interpolated across.",
            0.0);
  }
};

/// Poses of an estimate and of a reference that belong together: estimate[i] and reference[i].
struct Association {
  Trajectory estimate;              ///< stamps on the reference's clock (the offset is added)
  Trajectory reference;             ///< as recorded, or interpolated at the estimate's stamps
  std::size_t estimate_poses = 0;   ///< before matching
  std::size_t reference_poses = 0;  ///< before matching
  /// Share of the time known to the reference during which the estimate delivers, 0 to 1. A time
  /// is known, or delivered, where it lies between two poses without a hole between them.
  double coverage = 0.0;
  double mean_difference_s = 0.0;  ///< mean |stamp difference| of the pairs; 0 if interpolated

  [[nodiscard]] std::size_t size() const { return estimate.size(); }
};

/// Pairs poses by time. Nearest: each pose of the shorter trajectory takes the nearest one of the
/// longer within the tolerance; where two want the same one, the nearer keeps it. Interpolated:
/// every estimated pose that lies within the reference's time, outside its holes, gets a pair.
/// Fails if a trajectory is empty or nothing matches, and says both time spans. Stamps must not
/// decrease (checked).
Result<Association> associate(const Trajectory& estimate, const Trajectory& reference,
                              const AssociationOptions& options = {});

/// The longest pause that is no hole: max(max_gap_s, three median steps).
TimeNs longestStep(const Trajectory& trajectory, double max_gap_s);

}  // namespace parkade
