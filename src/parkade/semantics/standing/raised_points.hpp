// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/geometry/se3.hpp"
#include "parkade/types/ground_relief.hpp"
#include "parkade/types/landmark.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct RaisedPointOptions {
  double min_height_m = 0.25;
  double max_sigma_m = 0.2;
  int min_observations = 3;
  double range_m = 8.5;

  void visit(OptionVisitor& v) {
    v.field("min_height_m", min_height_m, "m", "Key points lower than this may be floor.", 0.05,
            2.0);
    v.field("max_sigma_m", max_sigma_m, "m", "Key points placed worse than this tell nothing.",
            1e-3, 10.0);
    v.field("min_observations", min_observations, "count", "And those seen less often.", 2, 1000);
    v.field("range_m", range_m, "m", "And those farther from the car.", 1.0, 100.0);
  }
};

/// Key points that surely lie above the floor and near the car: they show something upright
/// (SmearFinder, mapping/layers/wall_points.hpp). Heights are over the floor with its relief.
std::vector<RaisedPoint> raisedPoints(const std::vector<Landmark>& landmarks,
                                      const SE3& T_level_odom, const GroundRelief& relief,
                                      const RaisedPointOptions& options);

}  // namespace parkade
