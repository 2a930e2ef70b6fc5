// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/localization/place_decision.hpp"
#include "parkade/mapping/parking_map.hpp"

namespace parkade {

struct MapSearchOptions {
  int refined = 40;
  double ambiguity = 0.75;
  double least_fit = 0.4;
  double wrong_texts = 0.25;
  int enough_texts = 4;
  double least_fit_by_texts = 0.15;
  double min_inlier_share = 0.3;
  int max_iterations = 8;
  double coarse_radius_m = 0.25;
  int line_points = 400;

  void visit(OptionVisitor& v) {
    v.field("refined", refined, "count", "Best places of the whole map that are registered.", 1,
            1000);
    v.field("ambiguity", ambiguity, "ratio",
            "Another place that fits this well, compared with the best, leaves it open where the "
            "car is.",
            0.1, 1.0);
    v.field("least_fit", least_fit, "ratio",
            "Share of what was seen lately that has to be found in the map at the place told.",
            0.05, 1.0);
    v.field("wrong_texts", wrong_texts, "ratio",
            "Of the texts that stand where the map has one, so many may differ: some are misread.",
            0.0, 1.0);
    v.field("enough_texts", enough_texts, "count",
            "Where so many texts agree, less of the rest has to be found.", 1, 1000);
    v.field("least_fit_by_texts", least_fit_by_texts, "ratio",
            "Share of what was seen lately that has to be found then: paint that cars hid from one "
            "drive is in the other's map only.",
            0.0, 1.0);
    v.field("min_inlier_share", min_inlier_share, "ratio",
            "In place of the registration's: of another drive's lines more are worn or hidden.",
            0.0, 1.0);
    v.field("max_iterations", max_iterations, "count", "Steps of a registration, at most.", 1, 100);
    v.field("coarse_radius_m", coarse_radius_m, "m",
            "A line point counts for a place when its line is this near.", 0.05, 1.0);
    v.field("line_points", line_points, "count", "Of what was seen lately, spread evenly.", 50,
            100000);
  }
};

/// A saved map as a later drive finds itself in it.
struct SavedMap {
  explicit SavedMap(const ParkingMap& map);
  Submap landmarks;
  std::vector<SE2> slots;            ///< x into the slot, origin at the middle of its entrance
  std::vector<SE2> arrows;           ///< x ahead
  std::vector<Eigen::Vector3d> way;  ///< where the car was that made it
  /// How high the car stood that came nearest to a place; 0 where the map has no way.
  [[nodiscard]] double heightAt(const Eigen::Vector2d& p) const;
};

/// The car's surroundings of some tens of metres, gathered along its way: the vehicle frame.
struct Surroundings {
  SemanticFrame features;
  std::vector<SE2> slots;
  std::vector<SE2> arrows;
};

/// What a submap holds, as if one picture had shown it; sigmas no less than what lies between a
/// line and its like in the map of another drive.
SemanticFrame asFrame(const Submap& submap);

/// Where a slot lies: x into it, origin at the middle of its entrance.
SE2 slotFrame(const std::array<Eigen::Vector2d, 4>& corners);

/// Finds the car anywhere in a saved map, with no idea of where it is: each slot and arrow seen may
/// be any of the map's; such places are scored by all lines and landmarks, the best registered.
/// Rows of slots look alike: the place is told only where no other one fits as well.
/// docs/math/registration.md.
LoopResult findInMap(const Surroundings& surroundings, const SavedMap& map,
                     const MapSearchOptions& options, const RegistrationOptions& registration);

}  // namespace parkade
