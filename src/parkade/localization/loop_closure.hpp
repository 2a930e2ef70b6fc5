// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/core/options.hpp"
#include "parkade/localization/place_decision.hpp"

namespace parkade {

struct LoopOptions {
  double max_search_m = 4.0;
  double step_m = 0.5;
  double step_deg = 2.0;
  double coarse_radius_m = 0.25;
  int refined = 12;
  double ambiguity = 0.8;
  double least_fit = 0.5;

  void visit(OptionVisitor& v) {
    v.field(
        "max_search_m", max_search_m, "m",
        "Places farther from the expected one are not tried; a less certain pose closes no loop.",
        0.5, 20.0);
    v.field("step_m", step_m, "m", "Spacing of the places tried.", 0.1, 2.0);
    v.field("step_deg", step_deg, "deg", "Spacing of the headings tried.", 0.1, 10.0);
    v.field("coarse_radius_m", coarse_radius_m, "m",
            "A line point counts for a place when its line is this near.", 0.05, 1.0);
    v.field("refined", refined, "count", "Best places that are registered.", 1, 100);
    v.field("ambiguity", ambiguity, "ratio",
            "Another place that fits this well, compared with the best, makes the loop ambiguous.",
            0.1, 1.0);
    v.field("least_fit", least_fit, "ratio",
            "Share of what is seen that has to be found in the map at the place told.", 0.05, 1.0);
  }
};

/// Looks for a frame in a submap around an expected pose that is uncertain by sigma_m and
/// sigma_rad: every place within three sigma. Rows of slots fit themselves one slot further; such a
/// loop is refused as ambiguous unless something that does not repeat (an arrow, a marker's text, a
/// row's end) decides. docs/math/registration.md.
LoopResult searchInSubmap(const SemanticFrame& frame, const Submap& submap, const SE2& expected,
                          double sigma_m, double sigma_rad, const LoopOptions& loop,
                          const RegistrationOptions& registration,
                          const std::vector<Eigen::Vector3d>& viewpoints = {});

}  // namespace parkade
