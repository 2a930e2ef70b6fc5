// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/types/bev_image.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct LineOptions {
  double spacing_m = 0.08;
  double min_width_m = 0.05;
  double max_width_m = 0.36;
  double min_length_m = 0.3;
  double edge_sigma_px = 0.25;
  double label_sigma_px = 0.6;
  double sight_sigma_deg = 0.05;
  double min_contrast = 8.0;
  int min_confidence = 128;
  double camera_height_m = 1.0;

  void visit(OptionVisitor& v) {
    v.field("spacing_m", spacing_m, "m", "Distance of points along a line.", 0.01, 1.0);
    v.field("min_width_m", min_width_m, "m", "Narrower paint is no line.", 0.0, 1.0);
    v.field("max_width_m", max_width_m, "m", "Wider paint is no line.", 0.05, 1.0);
    v.field("min_length_m", min_length_m, "m", "Shorter pieces give no segment.", 0.1, 10.0);
    v.field("edge_sigma_px", edge_sigma_px, "px",
            "Error across a line whose edges the picture shows.", 0.01, 5.0);
    v.field("label_sigma_px", label_sigma_px, "px", "The same where only the labels tell.", 0.01,
            5.0);
    v.field("sight_sigma_deg", sight_sigma_deg, "deg",
            "Error of a camera's line of sight: far from it, its pixels cover several of the "
            "picture's.",
            0.0, 5.0);
    v.field("min_contrast", min_contrast, "grey values",
            "Paint differs this much from the floor beside it, for its edges to be measured.", 1.0,
            255.0);
    v.field("min_confidence", min_confidence, "of 255",
            "Lines are not measured where the network is less sure.", 0, 255);
    v.field(
        "camera_height_m", camera_height_m, "m",
        "Height of the cameras, for how much a wrong attitude moves a measured line; slots take "
        "each camera's own.",
        0.1, 5.0);
  }
};

/// The painted lines of a picture: slot, lane and stop lines.
struct Lines {
  std::vector<LinePoint> points;
  std::vector<LineSegment> segments;
};

/// Measures the middle of painted lines: from the labels' runs across them, refined with the
/// picture's edges (where both lie at half the contrast). Their sigma holds the pixels' noise and,
/// with the picture's middle as viewpoint, the errors of the attitude (attitude_sigma, rad) and of
/// the cameras' lines of sight. Points
/// beside what hides the floor are left out. The sizes of picture and labels must be those of their
/// geometry. Not straight lines become several segments; collinear pieces are joined over gaps.
Lines extractLines(const BevImage& bev, const BevLabels& labels, double attitude_sigma,
                   const LineOptions& options = {});

}  // namespace parkade
