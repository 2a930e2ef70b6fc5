// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "parkade/localization/registration.hpp"

namespace parkade {

/// What a search for the car in a map found.
struct LoopResult {
  bool accepted = false;
  std::string reason;         ///< why not, in words
  Registration registration;  ///< the best one
  double score = 0.0;         ///< of the best: share of the frame's features that fit
  double second = 0.0;        ///< of the best at another place
};

/// How much of a frame fits a submap at a pose: line points in metres' worth, and point landmarks,
/// each of which is as telling as several metres of line. Landmarks in the submap's area that are
/// not where they should be speak against the pose.
class PlaceScorer {
 public:
  /// radius: m, in which a line point finds its line; stride: takes every so many of them.
  PlaceScorer(const SemanticFrame& frame, const Submap& submap, double radius, std::size_t stride)
      : frame_(frame), submap_(submap), radius_(radius), stride_(stride) {}

  /// Share that fits, 0 to 1; little where little lies inside the submap.
  [[nodiscard]] double at(const SE2& T_map_vehicle) const;

 private:
  [[nodiscard]] bool inside(const Eigen::Vector2d& q) const;
  const SemanticFrame& frame_;
  const Submap& submap_;
  double radius_;
  std::size_t stride_;
};

/// A pose that a frame may have in a submap, and how well it fits there.
struct PlaceCandidate {
  SE2 T_map_vehicle;
  double score = 0.0;
};

/// The poses are the same place: to within a distance (m) and an angle (rad).
bool samePlace(const SE2& a, const SE2& b, double distance, double angle = 0.06);

/// Best first; those that score alike stay in their order.
void sortByScore(std::vector<PlaceCandidate>& candidates);

/// How many places are looked at, what makes two of them one, and what speaks against one.
struct PlaceRules {
  int refined = 12;        ///< places that are registered
  double spacing_m = 0.5;  ///< nearer candidates are one place
  double spacing_rad = 0.06;
  double ambiguity = 0.8;  ///< of the best score, that another place may not exceed
  double least_fit = 0.5;
  double wrong_texts = 0.0;    ///< a place is refused where more of its texts are other ones
  bool texts_exclude = false;  ///< such places are no rivals either
  /// Where so many texts agree (0: never), another least fit holds.
  int enough_texts = 0;
  double least_fit_by_texts = 0.5;
  bool landmarks_first = false;  ///< they are laid on one another before lines are
};

/// Whether texts refuse a place: where landmarks of both stand together, more than wrong_texts of
/// what zone markers and guide signs say differs, or of what these, arrows and limits do.
bool textsContradict(const SemanticFrame& frame, const Submap& submap, const SE2& T_map_vehicle,
                     const PlaceRules& rules);
/// Whether enough_texts of zone markers and guide signs agree; arrows and limits say the same all
/// over a garage.
bool textsSuffice(const SemanticFrame& frame, const Submap& submap, const SE2& T_map_vehicle,
                  const PlaceRules& rules);

/// Registers the best candidates of each place and takes the one that fits best; refuses it where
/// another place fits as well, or where markers bear other texts.
LoopResult decidePlace(const SemanticFrame& frame, const Submap& submap,
                       std::vector<PlaceCandidate> candidates, const PlaceRules& rules,
                       const RegistrationOptions& registration,
                       const std::vector<Eigen::Vector3d>& viewpoints = {});

}  // namespace parkade
