// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/core/time.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/driven_way.hpp"
#include "parkade/mapping/objects/existence.hpp"
#include "parkade/mapping/objects/label_sight.hpp"
#include "parkade/mapping/parking_map.hpp"
#include "parkade/mapping/votes.hpp"
#include "parkade/types/level_view.hpp"

namespace parkade {

/// What cameras' own pictures say of things that stand or hang there.
struct ViewExistenceOptions {
  double detection = 0.5;
  double false_alarm = 0.15;
  int min_hits = 3;

  void visit(OptionVisitor& v) {
    v.field("detection", detection, "probability",
            "That a picture that looks at one shows one there.", 0.01, 0.99);
    v.field("false_alarm", false_alarm, "probability",
            "That it shows one where none is: errors repeat, and places lie off.", 0.01, 0.99);
    v.field("min_hits", min_hits, "count",
            "Those that fewer pictures showed are not told, where there are such pictures.", 0,
            1000);
  }
  /// By pictures with and without it; whether one had been expected counts elsewhere.
  [[nodiscard]] double logOdds(const Existence& in_views) const {
    constexpr double kEven = 0.5;
    return in_views.logOdds({detection, false_alarm, kEven});
  }
};

struct ObjectRegistryOptions {
  double association_sigma_m = 0.15;
  double max_distance_m = 1.0;
  double position_floor_m = 0.03;
  int min_observations = 3;
  int min_marker_observations = 1;
  double min_own_share = 0.45;
  double duplicate_overlap = 0.3;
  double marker_reach_m = 8.0;
  ExistenceOptions paint{0.4, 0.1, 0.1};
  ExistenceOptions upright{0.6, 0.25, 0.1};  // smears beside pillars look alike again and again
  ViewExistenceOptions pillar_views{0.8, 0.3, 2};
  ViewExistenceOptions sign_views{0.5, 0.15, 3};

  void visit(OptionVisitor& v) {
    v.field("association_sigma_m", association_sigma_m, "m",
            "What an object may lie off beside its covariance: errors of the pose.", 0.0, 2.0);
    v.field("max_distance_m", max_distance_m, "m", "Objects farther apart are never one.", 0.1,
            10.0);
    v.field("position_floor_m", position_floor_m, "m",
            "No place is measured better than this, nor told to be by any number of looks.", 1e-4,
            1.0);
    v.field("min_observations", min_observations, "count", "Objects seen less often are not told.",
            1, 1000);
    v.field("min_marker_observations", min_marker_observations, "count",
            "The same of zone markers and signs, whose observations rest on several views each.", 1,
            1000);
    v.field("min_own_share", min_own_share, "ratio",
            "Of the pixels at an object's place that are labelled as its class or as one that has "
            "its looks, so many must be of its class.",
            0.0, 1.0);
    v.field("duplicate_overlap", duplicate_overlap, "ratio",
            "Of two of a class that share more of the smaller one's area, one is told.", 0.05, 1.0);
    v.field("marker_reach_m", marker_reach_m, "m",
            "A zone marker that the car passed so near is told where it was measured twice or a "
            "pillar bears it.",
            0.0, 100.0);
    v.group("paint", paint);
    v.group("upright", upright);
    v.group("pillar_views", pillar_views);
    v.group("sign_views", sign_views);
  }
};

/// Arrows, limits, stop lines, crossings, bumps, pillars, zone markers and signs that were seen:
/// stable ids, places fused over all observations, texts by vote, none twice. World frame.
class ObjectRegistry {
 public:
  explicit ObjectRegistry(const ObjectRegistryOptions& options) : options_(options) {}

  /// labels: of the picture that the observations come from. Where given, objects in plain sight
  /// there that were not observed lose evidence, and their places' labels vote on them. views: of
  /// the same instant; each confirms or refutes the pillars and signs that it looks at. new_view:
  /// false where the vehicle stands as in the frame before, which tells zone markers and signs
  /// alone: their observations rest on views of their own.
  void update(const std::vector<ObjectObservation>& observations, const SE2& T_world_vehicle,
              double z_vehicle, std::int64_t anchor, const BevLabels* labels = nullptr,
              const std::vector<LevelView>& views = {}, bool new_view = true);
  /// As SlotRegistry's.
  void moveWithAnchors(const std::function<SE2(std::int64_t)>& correction);
  /// Moves all of them up, m: the world is called otherwise.
  void raise(double dz);
  /// Those that exist by what plain sight shows, none on another of its class; ordered by id.
  /// Without labels, and where there is no outline: those observed often enough. Sigmas hold the
  /// errors that all looks share. Texts of zone markers are made alike (text_format.hpp) and follow
  /// the grid that most of them stand in (marker_grid.hpp).
  [[nodiscard]] std::vector<MapObject> objects() const;

 private:
  struct Track {
    std::int64_t id = 0;
    std::int64_t anchor = 0;
    SemanticClass semantic_class = SemanticClass::kUnknown;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    Eigen::Vector2d heading = Eigen::Vector2d::Zero();  // sum of unit vectors, weighted
    Votes texts;
    std::vector<Eigen::Vector2d> outline;
    double outline_confidence = 0.0;
    std::int64_t observations = 0;
    Existence existence;
    Existence in_views;  ///< of a pillar or sign, by cameras' own pictures
    AreaShares votes;    ///< sum of what the labels showed of its place in plain sight
    [[nodiscard]] bool isUpright() const;
    [[nodiscard]] bool isSign() const;
  };
  /// A camera's picture and where it was taken.
  struct Look {
    LevelView view;
    SE2 T_world_vehicle;
    double z_vehicle = 0.0;
    std::int64_t anchor = 0;
  };
  [[nodiscard]] std::size_t match(const ObjectObservation& o, double heading,
                                  const Eigen::Vector3d& p, const Eigen::Matrix3d& covariance,
                                  const std::vector<bool>& used) const;
  void look(const BevLabels& labels, const SE2& T_world_vehicle, const std::vector<bool>& observed);
  void lookAcross(const LevelView& view, const SE2& T_world_vehicle);
  /// Signs are told late, when their best views are over: a new one is looked for in those, too.
  void lookBack(Track& sign) const;
  void lookUp(Look look);
  static void lookUpAt(Track& sign, const Look& look);
  /// Log-odds.
  [[nodiscard]] double existence(const Track& track) const;
  [[nodiscard]] bool exists(const Track& track) const;
  [[nodiscard]] bool isPhantom(const Track& marker) const;
  [[nodiscard]] bool compatible(const Track& a, SemanticClass c, const Eigen::Vector3d& p,
                                double heading, bool has_heading) const;
  [[nodiscard]] std::vector<const Track*> told() const;
  [[nodiscard]] static const Track& placedBy(const Track& track,
                                             const std::vector<const Track*>& told);
  [[nodiscard]] static std::vector<std::string> textsOf(const std::vector<const Track*>& told);
  static void fuse(Track& track, const Eigen::Vector3d& p, const Eigen::Matrix3d& covariance);
  void mergeDuplicates();

  ObjectRegistryOptions options_;
  std::vector<Track> tracks_;
  std::deque<Look> looks_;  ///< the latest, oldest first
  DrivenWay way_{1.0};
  std::int64_t next_id_ = 1;
  bool sighted_ = false;  ///< labels were given
  bool viewed_ = false;   ///< views were given
};

}  // namespace parkade
