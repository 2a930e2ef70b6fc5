// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/semantics/bev_views.hpp"
#include "parkade/semantics/slots/slot_clues.hpp"
#include "parkade/types/bev_image.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct SlotOptions {
  double min_width_m = 2.1;
  double max_width_m = 4.1;
  double min_depth_m = 4.5;
  double max_depth_m = 7.0;
  double min_parallel_length_m = 5.2;
  double max_parallel_length_m = 7.5;
  double min_parallel_depth_m = 1.8;
  double max_parallel_depth_m = 3.0;
  double usual_depth_m = 5.0;
  double usual_parallel_depth_m = 2.2;
  double min_confidence = 0.7;
  double min_faint_contrast = 1.5;
  double min_lone_contrast = 3.5;

  void visit(OptionVisitor& v) {
    v.field("min_width_m", min_width_m, "m",
            "Width of a perpendicular or slanted slot, between the middles of its lines.", 1.0,
            10.0);
    v.field("max_width_m", max_width_m, "m", "The same, at most.", 1.0, 10.0);
    v.field("min_depth_m", min_depth_m, "m", "Length of its sides.", 1.0, 20.0);
    v.field("max_depth_m", max_depth_m, "m", "The same, at most.", 1.0, 20.0);
    v.field("min_parallel_length_m", min_parallel_length_m, "m",
            "Entrance of a slot that lies along the aisle.", 1.0, 20.0);
    v.field("max_parallel_length_m", max_parallel_length_m, "m", "The same, at most.", 1.0, 20.0);
    v.field("min_parallel_depth_m", min_parallel_depth_m, "m", "Its sides.", 1.0, 10.0);
    v.field("max_parallel_depth_m", max_parallel_depth_m, "m", "The same, at most.", 1.0, 10.0);
    v.field("usual_depth_m", usual_depth_m, "m",
            "Sides of a slot whose rear is not seen, where no other slot tells.", 1.0, 20.0);
    v.field("usual_parallel_depth_m", usual_parallel_depth_m, "m",
            "The same of a slot along the aisle.", 1.0, 10.0);
    v.field("min_confidence", min_confidence, "probability", "Doubtful slots are not told.", 0.0,
            1.0);
    v.field("min_faint_contrast", min_faint_contrast, "log-odds",
            "Worn lines beside a slot stand out so much, on average along them, over the floor.",
            0.1, 10.0);
    v.field("min_lone_contrast", min_lone_contrast, "log-odds",
            "The same beside a slot's side where no slot of the row is told.", 0.1, 10.0);
  }
};

/// What the levelling of a picture may be wrong by, 1 sigma.
struct FloorSigma {
  double attitude = 0.0;  ///< rad, pitch and roll
  double height = 0.0;    ///< m
};

/// A candidate and what was held for and against it: what weights are fitted to.
struct SlotTrial {
  Eigen::Vector2d left = Eigen::Vector2d::Zero();  ///< m, level frame: entrance corners
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  SlotClues clues = {};
  double doubt = 0.0;
};

/// Finds parking slots: two marks (slot_marks.hpp) whose side lines run side by side, as far apart
/// as the standards make slots (slot_candidates.hpp), with nothing painted in between, room to
/// drive in front and no better explanation beside them (slot_ranking.hpp). Their rows are followed
/// over lines that are too worn for labels (slot_rows.hpp). Of slots that overlap the likelier one
/// is told. Corners lie where the lines' middles meet; their covariance holds the
/// picture's noise and the errors of the levelling, which move both corners together. Whether a
/// slot is free comes from the labels inside (slot_occupancy.hpp). labels must be those of bev
/// (checked); segments from extractLines. trials, if given, gets all candidates.
std::vector<SlotObservation> extractSlots(const BevImage& bev, const BevLabels& labels,
                                          const std::vector<LineSegment>& segments,
                                          const BevViews& views, const FloorSigma& sigma,
                                          const SlotOptions& options = {},
                                          std::vector<SlotTrial>* trials = nullptr);

}  // namespace parkade
