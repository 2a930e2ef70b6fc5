// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/types/semantic_class.hpp"

namespace parkade {

/// Whether a label hides the floor or tells nothing of it: no edge of paint is seen beside it.
bool hidesFloor(SemanticClass semantic_class);

/// One row's stretch of a painted line. Across the row: begin to end, px, whole pixels.
struct LineRun {
  int row = 0;
  double center = 0.0;
  double width = 0.0;
  bool hidden = false;  ///< a side of it borders on what hides the floor
};

/// Runs that follow each other from row to row: a piece of line that crosses the rows.
struct LineChain {
  SemanticClass semantic_class = SemanticClass::kSlotLine;
  std::vector<LineRun> runs;

  /// Straight line through the runs around index: centre at that run's row, and px per row.
  void fitAround(std::size_t index, double& center, double& slope) const;
};

/// Follows slot, lane and stop lines through the rows of a label picture (CV_8UC1). Runs wider than
/// max_run px are no line that crosses the rows.
std::vector<LineChain> followLines(const cv::Mat& labels, double max_run);

}  // namespace parkade
