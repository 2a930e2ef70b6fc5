// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/vio/window.hpp"

namespace parkade {

struct TriangulationLimits {
  double min_parallax = 0.005;  ///< rad between two rays, or
  int patience = 6;             ///< observations, after which a point may be as far as it likes
  double max_rms = 2.5;         ///< whitened reprojection error over the observations
  double max_error = 4.5;       ///< of the worst of them
  double min_distance = 0.1;    ///< m
};

/// Places a feature from all its observations, any camera, with the frames' poses as they are:
/// linear midpoint, then Gauss-Newton on the reprojection error. Sets has_point and the anchor.
/// False where it cannot be placed (yet); failures counts contradictions, not lack of parallax.
bool triangulate(const Window& window, WindowFeature& feature, const TriangulationLimits& limits);

}  // namespace parkade
