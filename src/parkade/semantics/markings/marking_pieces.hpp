// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// Paint of one class that belongs together.
struct MarkingPiece {
  SemanticClass semantic_class = SemanticClass::kUnknown;
  std::vector<Eigen::Vector2d> points;  ///< ground points of its pixels, levelled vehicle frame
  std::vector<bool> at_edge;            ///< of each: the floor beside it is hidden
  double confidence = 0.0;              ///< mean of the labels' confidence, 0 to 1
  bool cut = false;        ///< goes on where the picture ends, or under what hides the floor
  bool may_go_on = false;  ///< the same beyond a gap in the paint: a crossing's next bar
};

/// Whether a label hides the floor or tells nothing of it.
bool hidesGround(SemanticClass semantic_class);

/// The paint of the classes that are objects (not lines), in pieces of at least min_pixels (8
/// for arrows, whose parts arrow_fitting.hpp joins). Worn paint is joined over gaps that depend on
/// the class; a crossing's bars are one piece.
std::vector<MarkingPiece> findMarkings(const BevLabels& labels, int min_confidence, int min_pixels);

}  // namespace parkade
