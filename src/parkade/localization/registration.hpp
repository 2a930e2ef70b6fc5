// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/submap.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct RegistrationOptions {
  int max_iterations = 15;
  double search_radius_m = 0.5;
  double final_radius_m = 0.15;
  double robust_sigma = 2.0;
  double line_floor_m = 0.01;
  double max_sigma_m = 0.08;
  double lever_m = 5.0;
  double floor_m = 0.005;
  int min_matches = 30;
  double min_inlier_share = 0.6;
  double min_overlap = 0.25;
  double max_rms = 2.5;

  void visit(OptionVisitor& v) {
    v.field("max_iterations", max_iterations, "count", "Steps, at most.", 1, 100);
    v.field("search_radius_m", search_radius_m, "m",
            "A line point looks this far for its line in the first step.", 0.05, 1.0);
    v.field("final_radius_m", final_radius_m, "m", "The same in the last steps.", 0.02, 1.0);
    v.field("robust_sigma", robust_sigma, "sigma", "Scale of the Cauchy loss.", 0.5, 100.0);
    v.field("line_floor_m", line_floor_m, "m",
            "What painted lines and their points err at least, whatever their sigma says.", 1e-4,
            0.2);
    v.field("max_sigma_m", max_sigma_m, "m",
            "A direction that is known less well is not observable: no step, no information.",
            0.005, 1.0);
    v.field("lever_m", lever_m, "m", "Distance at which an angle counts as a length.", 0.5, 50.0);
    v.field("floor_m", floor_m, "m", "No direction is known better than this.", 0.0, 0.1);
    v.field("min_matches", min_matches, "count", "Fewer matched line points are no fit.", 3, 10000);
    v.field("min_inlier_share", min_inlier_share, "ratio",
            "Of the matched line points, this share must fit.", 0.0, 1.0);
    v.field("min_overlap", min_overlap, "ratio", "Share of the line points that must find a line.",
            0.0, 1.0);
    v.field("max_rms", max_rms, "sigma", "Root mean square of the whitened inliers, at most.", 0.5,
            100.0);
  }
};

/// How a frame lies in a submap, and how sure that is.
struct Registration {
  bool accepted = false;
  std::string reason;  ///< why not, in words; else empty
  SE2 T_map_vehicle;   ///< levelled vehicle
  /// Of T_map_vehicle (right perturbation: x, y, angle), from the features alone: the prior pose is
  /// not in it. Zero along directions that are not observable, as along a lone line.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  int observable = 0;  ///< directions, 0 to 3
  int line_matches = 0;
  int line_inliers = 0;
  int point_inliers = 0;
  double inlier_share = 0.0;
  double overlap = 0.0;
  double rms = 0.0;  ///< of whitened inlier residuals
  int iterations = 0;
  double pitch = 0.0;  ///< rad, correction of the picture's levelling that fits best
  double roll = 0.0;
};

/// Lays a frame's line points, slot corners and point landmarks on those of a submap, class by
/// class: robust point-to-line and point-to-point distances, Gauss-Newton over the pose in the
/// plane and the error of the picture's pitch and roll, starting at the prior.
/// viewpoints: the cameras' places in the vehicle frame (the nearest one saw a point); where empty,
/// one at the picture's middle, 1 m high. docs/math/registration.md.
Registration registerFrame(const SemanticFrame& frame, const Submap& submap,
                           const SE2& T_map_vehicle_prior, const RegistrationOptions& options,
                           const std::vector<Eigen::Vector3d>& viewpoints = {});

}  // namespace parkade
