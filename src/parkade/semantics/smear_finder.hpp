// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/semantics/bev_views.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct SmearOptions {
  double pillar_depth_m = 0.45;
  double wall_depth_m = 0.3;
  double edge_m = 0.15;
  double wheel_stop_depth_m = 0.2;
  double least_m = 0.2;
  double wall_least_m = 0.3;

  void visit(OptionVisitor& v) {
    v.field("pillar_depth_m", pillar_depth_m, "m",
            "Of a pillar's labels, so much behind its near edge is taken for its place.", 0.05,
            10.0);
    v.field("wall_depth_m", wall_depth_m, "m", "The same of a wall's.", 0.05, 10.0);
    v.field("edge_m", edge_m, "m",
            "Of that, so much is surely its place; the rest may as well be hidden floor.", 0.0,
            10.0);
    v.field("wheel_stop_depth_m", wheel_stop_depth_m, "m",
            "What a wheel stop is deep; the floor behind it is seen again.", 0.05, 1.0);
    v.field("least_m", least_m, "m",
            "Structure that a sight line must cross before it counts as blocked.", 0.0, 2.0);
    v.field("wall_least_m", wall_least_m, "m",
            "Wall that it must cross before nothing behind is believed, floor neither.", 0.0, 50.0);
  }
};

/// A bird's-eye picture draws pillars and walls all the way from where they stand to where the
/// sight line leaves their top; only the near edge lies where it is drawn. A map that believes the
/// rest grows streaks behind everything upright. Finds what is labelled pillar, wall, zone marker
/// or wheel stop deeper behind the near edge than such a thing is thick, seen from the camera of
/// that part of the picture, or behind a car, which hides where it stands; and whatever is labelled
/// behind a wall, which hides all the ground: the smear of a bare wall passes for floor.
class SmearFinder {
 public:
  SmearFinder(const BevGeometry& geometry, const BevViews& views, const SmearOptions& options);

  /// SemanticFrame::smear. labels: of the geometry given at first (checked).
  [[nodiscard]] cv::Mat find(const BevLabels& labels) const;

 private:
  struct Step {
    int pixel = 0;       // in memory
    int before = -1;     // the pixel before it on the sight line, -1 at its start
    float length = 0.0;  // m between the two
  };
  BevGeometry geometry_;
  SmearOptions options_;
  std::vector<Step> outwards_;  // ordered by distance from their camera
};

}  // namespace parkade
