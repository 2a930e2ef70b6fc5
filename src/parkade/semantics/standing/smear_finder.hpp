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
  double point_half_width_m = 0.3;

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
    v.field("point_half_width_m", point_half_width_m, "m",
            "What a raised key point lies on reaches so far to either side.", 0.0, 2.0);
  }
};

/// A bird's-eye picture draws pillars and walls all the way from where they stand to where the
/// sight line leaves their top; only the near edge lies where it is drawn. A map that believes the
/// rest grows streaks behind everything upright. Finds what is labelled pillar, wall, zone marker
/// or wheel stop deeper behind the near edge than such a thing is thick, seen from the camera of
/// that part of the picture, or behind a car, which hides where it stands; and whatever is labelled
/// behind a wall, which hides all the ground: the smear of a bare wall passes for floor.
///
/// Where a network takes all of a wall for floor, key points know better: what shows one at height
/// z, seen from a camera of height h at the distance d, is drawn at d h / (h - z), and no ground is
/// seen from its foot up to there. Whatever is labelled ground there is smear too, or structure
/// deeper than it is thick, unless the labels show the structure that the point belongs to.
class SmearFinder {
 public:
  SmearFinder(const BevGeometry& geometry, const BevViews& views, const SmearOptions& options);

  /// SemanticFrame::smear. labels: of the geometry given at first (checked). raised: key points
  /// above the floor, in the picture's levelled frame, m.
  [[nodiscard]] cv::Mat find(const BevLabels& labels,
                             const std::vector<RaisedPoint>& raised = {}) const;

 private:
  struct Step {
    int pixel = 0;     // in memory
    bool own = false;  // shown by the ray's camera
  };
  struct Ray {
    std::size_t begin = 0;  // of its steps
    std::size_t end = 0;
    float length = 0.0F;  // m, of a step
  };
  /// The sight line from a view's foot to a pixel at the border, as far as the view shows it.
  void addRay(std::size_t view, int u, int v);
  /// By pixel, how far behind it key points hide the ground, m.
  [[nodiscard]] std::vector<float> hiddenBehind(const cv::Mat& labels,
                                                const std::vector<RaisedPoint>& raised) const;
  [[nodiscard]] bool standsOnStructure(const cv::Mat& labels, const Eigen::Vector2d& foot,
                                       const Eigen::Vector2d& outwards) const;

  BevGeometry geometry_;
  BevViews views_;
  SmearOptions options_;
  std::vector<Ray> rays_;
  std::vector<Step> steps_;
};

}  // namespace parkade
