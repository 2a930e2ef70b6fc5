// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/semantics/markings/marking_pieces.hpp"
#include "parkade/semantics/markings/marking_shape.hpp"

namespace parkade {

/// What an arrow's paint must be like.
struct ArrowLimits {
  double min_overlap = 0.45;  ///< intersection over union with its shape
  double min_length = 1.1;    ///< m
  double max_length = 8.0;    ///< m
};

/// Paint of one arrow, and the shape that it is taken for.
struct FittedArrow {
  MarkingPiece paint;
  ShapeFit fit;
};

/// Arrows in pieces of arrow paint whose pixels have sides of the given length (m). Wear parts an
/// arrow's head from its shaft, and arrows one behind the other may touch: of the ways to take
/// pieces together or apart the one is chosen in which shapes cover most of the paint. Pieces that
/// no arrow's shape fits, or a plain bar (a shape without a meaning) fits better, and those that
/// are cut off are left out.
std::vector<FittedArrow> fitArrows(std::vector<MarkingPiece> pieces, double pixel,
                                   const std::vector<MarkingShape>& shapes,
                                   const ArrowLimits& limits);

}  // namespace parkade
