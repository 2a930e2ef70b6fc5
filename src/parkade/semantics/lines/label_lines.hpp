// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/semantics/bev_views.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct LabelLineOptions {
  int stride_px = 3;
  double window_m = 0.36;
  double max_width_m = 0.30;
  double spacing_m = 0.12;
  double sigma_px = 0.35;
  int min_confidence = 128;

  void visit(OptionVisitor& v) {
    v.field("stride_px", stride_px, "px", "Paint is looked at in pixels about so far apart.", 1,
            20);
    v.field("window_m", window_m, "m", "Half side of the piece of paint around a pixel.", 0.1, 2.0);
    v.field("max_width_m", max_width_m, "m", "Wider paint is no line.", 0.05, 1.0);
    v.field("spacing_m", spacing_m, "m", "Between line points.", 0.02, 1.0);
    v.field("sigma_px", sigma_px, "px", "Error of a line point across its line.", 0.01, 5.0);
    v.field("min_confidence", min_confidence, "of 255", "Less sure pixels are no paint.", 0, 255);
  }
};

/// Points on the middle of painted lines (slot, lane and stop lines), from the labels of a
/// bird's-eye picture alone: the paint around a pixel must be long and narrow; its direction is the
/// main axis of that paint, its middle the mean of a short piece across. sigma holds the attitude's
/// error (attitude_sigma, rad) as the camera that shows the point sees it.
std::vector<LinePoint> linePointsFromLabels(const BevLabels& labels, const BevViews& views,
                                            double attitude_sigma, const LabelLineOptions& options);

/// Straight pieces through line points of one class: those that share a direction to 5 degrees and
/// an offset to a few centimetres, without gaps over a metre, 1 m long or more.
std::vector<LineSegment> segmentsOf(const std::vector<LinePoint>& points);

}  // namespace parkade
