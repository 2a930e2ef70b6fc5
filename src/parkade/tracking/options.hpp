// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/core/options.hpp"

namespace parkade {

/// Where new corners are looked for.
struct DetectionOptions {
  int features = 150;
  double rest_s = 0.08;
  double min_distance_px = 10.0;
  double min_gradient = 3.0;
  double min_gradient_noise = 1.2;
  int block_px = 5;
  void visit(OptionVisitor& v) {
    v.field("features", features, "count",
            "Features aimed at per camera: the image is divided into as many cells.", 4, 2000);
    v.field("min_distance_px", min_distance_px, "px", "Least distance between two features.", 2,
            200);
    v.field("min_gradient", min_gradient, "grey/px",
            "Least gradient in a corner's weakest direction (root mean square over the block).", 0,
            255);
    v.field("min_gradient_noise", min_gradient_noise, "ratio",
            "The same as a multiple of the standard deviation of the picture's noise, where that "
            "is more.",
            0, 100);
    v.field("rest_s", rest_s, "s", "Time for which a cell without a corner is not looked at again.",
            0, 1);
    v.field("block_px", block_px, "px", "Side of the block whose gradients make a corner.", 3, 15);
  }
};

/// How a corner is followed from frame to frame.
struct FlowOptions {
  int window_px = 15;
  int levels = 3;
  int iterations = 15;
  double epsilon_px = 0.03;
  double max_backward_px = 1.0;
  bool refine = true;
  double min_correlation = 0.75;
  double max_refine_px = 1.5;
  double max_scale = 1.6;
  double affine_sigma = 1.0;
  double max_gap_s = 0.35;
  double sigma_floor_px = 0.35;
  void visit(OptionVisitor& v) {
    v.field("window_px", window_px, "px", "Side of the window of the pyramidal flow.", 7, 41);
    v.field("levels", levels, "count", "Pyramid levels above the image itself.", 0, 6);
    v.field("iterations", iterations, "count", "Most iterations per level.", 1, 100);
    v.field("epsilon_px", epsilon_px, "px", "Step at which the flow has converged.", 1e-4, 1);
    v.field("max_backward_px", max_backward_px, "px",
            "Most distance from the start after flowing forward and back.", 0.05, 20);
    v.field("refine", refine,
            "Align each feature with the patch of its first picture, so that it cannot creep.");
    v.field("min_correlation", min_correlation, "ratio",
            "Least correlation with the first picture's patch.", 0, 1);
    v.field("max_refine_px", max_refine_px, "px",
            "Most distance between the flow's result and the aligned one.", 0.1, 20);
    v.field("max_scale", max_scale, "ratio",
            "Change of scale or shape from which on a feature takes a new patch.", 1.05, 10);
    v.field("affine_sigma", affine_sigma, "ratio",
            "Expected change of a patch's shape between frames (standard deviation). Near floor "
            "grows by a third per frame at 15 km/h and 10 Hz; too small a value drags the position "
            "along, always the same way.",
            1e-4, 10);
    v.field("max_gap_s", max_gap_s, "s",
            "Longest time without a picture over which features are kept.", 0, 5);
    v.field(
        "sigma_floor_px", sigma_floor_px, "px",
        "Least standard deviation of an observation: calibration and patches that are not flat.",
        0.01, 5);
  }
};

/// How outliers are told from the camera's motion.
struct OutlierOptions {
  bool enabled = true;
  double max_epipolar_px = 1.2;
  int iterations = 40;
  int min_features = 12;
  void visit(OptionVisitor& v) {
    v.field("enabled", enabled, "Drop features that contradict the camera's motion.");
    v.field("max_epipolar_px", max_epipolar_px, "px",
            "Most distance from the epipolar plane, at the image centre's scale.", 0.1, 50);
    v.field("iterations", iterations, "count", "Pairs of features tried as hypotheses.", 1, 1000);
    v.field("min_features", min_features, "count", "Fewer features than this are not judged.", 5,
            1000);
  }
};

/// How the features of overlapping cameras are matched.
struct MatchingOptions {
  bool enabled = true;
  double min_overlap = 0.03;
  double min_depth_m = 0.4;
  double min_correlation = 0.85;
  double min_search_correlation = 0.6;
  double uniqueness = 0.08;
  double max_epipolar_px = 1.5;
  int retry_frames = 5;
  void visit(OptionVisitor& v) {
    v.field("enabled", enabled, "Match features between cameras that overlap.");
    v.field("min_overlap", min_overlap, "ratio",
            "Least share of an image that another camera sees, for the pair to be matched.", 0, 1);
    v.field("min_depth_m", min_depth_m, "m", "Nearest point searched for.", 0.05, 100);
    v.field("min_correlation", min_correlation, "ratio",
            "Least correlation of the aligned patches of a match.", 0, 1);
    v.field("min_search_correlation", min_search_correlation, "ratio",
            "Least correlation along the epipolar curve.", 0, 1);
    v.field("uniqueness", uniqueness, "ratio",
            "Least lead in correlation over the second best place.", 0, 1);
    v.field("max_epipolar_px", max_epipolar_px, "px",
            "Most distance from the epipolar plane of the known extrinsics.", 0.1, 50);
    v.field("retry_frames", retry_frames, "count", "Frames between two tries to match a feature.",
            1, 100);
  }
};

/// How dark or flat images are brightened before anything else.
struct ContrastOptions {
  std::string mode = "auto";
  double dark_level = 60.0;
  double min_range = 100.0;
  double blind_range = 6.0;
  void visit(OptionVisitor& v) {
    v.field("mode", mode,
            "auto: a smooth tone curve on dark or flat images; clahe: local histogram equalisation "
            "of every image; off: images as they are.",
            {"auto", "clahe", "off"});
    v.field("dark_level", dark_level, "grey", "Median below which an image counts as dark.", 0,
            255);
    v.field("min_range", min_range, "grey",
            "Distance of the 1 % and 99 % grey levels below which an image counts as flat.", 0,
            255);
    v.field("blind_range", blind_range, "grey",
            "Distance of these levels below which a camera sees nothing.", 0, 255);
  }
};

struct TrackingOptions {
  DetectionOptions detection;
  FlowOptions flow;
  OutlierOptions outliers;
  MatchingOptions matching;
  ContrastOptions contrast;
  void visit(OptionVisitor& v) {
    v.group("detection", detection);
    v.group("flow", flow);
    v.group("outliers", outliers);
    v.group("matching", matching);
    v.group("contrast", contrast);
  }
};

}  // namespace parkade
