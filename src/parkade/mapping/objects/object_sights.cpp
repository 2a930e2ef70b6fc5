// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// Of the object registry: what pictures show where objects are known.
#include <utility>

#include "parkade/mapping/objects/column_sight.hpp"
#include "parkade/mapping/objects/object_registry.hpp"
#include "parkade/mapping/objects/sign_sight.hpp"

namespace parkade {

void ObjectRegistry::look(const BevLabels& labels, const SE2& T_world_vehicle,
                          const std::vector<bool>& observed) {
  sighted_ = true;
  constexpr double kRange = 8.5;  // m
  constexpr double kMostHidden = 0.1;
  const LabelSight sight(labels, kRange);
  const SE2 T_vehicle_world = T_world_vehicle.inverse();
  std::vector<Eigen::Vector2d> outline;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Track& track = tracks_[i];
    if (!sight.reaches(T_vehicle_world * track.position.head<2>())) continue;
    outline.clear();
    for (const Eigen::Vector2d& p : track.outline) outline.push_back(T_vehicle_world * p);
    const AreaShares shares = sight.of(outline, track.semantic_class);
    if (shares.unseen + shares.covered > kMostHidden) continue;
    // Something upright that is labelled there is not missed where its foot could not be measured.
    const bool labelled = track.isUpright() && shares.own > 0.5;
    if (i >= observed.size() || observed[i]) {
      ++track.existence.hits;
    } else if (!labelled) {
      ++track.existence.misses;
    }
    track.votes.own += shares.own;
    track.votes.rival += shares.rival;
    track.votes.floor += shares.floor;
  }
}

void ObjectRegistry::lookAcross(const LevelView& view, const SE2& T_world_vehicle) {
  viewed_ = true;
  const SE2 T_vehicle_world = T_world_vehicle.inverse();
  std::vector<Track*> pillars;
  std::vector<Eigen::Vector2d> feet;
  for (Track& track : tracks_) {
    if (track.semantic_class != SemanticClass::kPillar) continue;
    pillars.push_back(&track);
    feet.emplace_back(T_vehicle_world * track.position.head<2>());
  }
  for (std::size_t i = 0; i < pillars.size(); ++i) {
    const ColumnSight sight = columnSight(view, feet[i]);
    if (sight == ColumnSight::kNotThere) ++pillars[i]->in_views.misses;
    if (sight != ColumnSight::kThere) continue;
    // What a better known pillar shows says nothing of one behind it, nor, if it is known much
    // better, of one before it.
    constexpr std::int64_t kMuch = 3;
    const Eigen::Vector2d eye = view.eye.head<2>();
    bool explained = false;
    for (std::size_t j = 0; j < pillars.size() && !explained; ++j) {
      const bool before = (feet[j] - eye).norm() < (feet[i] - eye).norm();
      explained = pillars[j]->observations > (before ? 1 : kMuch) * pillars[i]->observations &&
                  standsInLine(feet[j], feet[i], eye);
    }
    if (!explained) ++pillars[i]->in_views.hits;
  }
}

void ObjectRegistry::lookUpAt(Track& sign, const Look& look) {
  Eigen::Vector3d p;
  p << look.T_world_vehicle.inverse() * sign.position.head<2>(), sign.position.z() - look.z_vehicle;
  const ColumnSight sight = signSight(look.view, p, sign.semantic_class);
  sign.in_views.hits += sight == ColumnSight::kThere ? 1 : 0;
  sign.in_views.misses += sight == ColumnSight::kNotThere ? 1 : 0;
}

void ObjectRegistry::lookBack(Track& sign) const {
  for (const Look& look : looks_) lookUpAt(sign, look);
}

void ObjectRegistry::lookUp(Look look) {
  for (Track& track : tracks_) {
    if (track.isSign()) lookUpAt(track, look);
  }
  constexpr std::size_t kKept = 60;  // some 25 m of way with a picture every 0.4 m
  looks_.push_back(std::move(look));
  if (looks_.size() > kKept) looks_.pop_front();
}

}  // namespace parkade
