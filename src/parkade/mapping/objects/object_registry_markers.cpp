// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// What the registry knows of zone markers by all of them together: docs/math/zone_markers.md.
#include <algorithm>

#include "parkade/mapping/objects/marker_grid.hpp"
#include "parkade/mapping/objects/object_registry.hpp"

namespace parkade {
namespace {

constexpr double kPillarNear = 1.5;  // m: a marker this near hangs on it

}  // namespace

// Who passes a marker sees it from many places. One that was measured once all the same, where no
// pillar is, was put together from bearings to different ones; so was one further away that bears
// the name of another, well known.
bool ObjectRegistry::isPhantom(const Track& marker) const {
  constexpr int kWellKnown = 3;  // observations
  if (marker.observations > 1) return false;
  const Eigen::Vector2d p = marker.position.head<2>();
  const auto carries = [&](const Track& track) {
    return track.semantic_class == SemanticClass::kPillar &&
           (track.position.head<2>() - p).norm() < kPillarNear && exists(track);
  };
  if (std::any_of(tracks_.begin(), tracks_.end(), carries)) return false;
  if (way_.passed(p, options_.marker_reach_m)) return true;
  const std::string name = marker.texts.best();
  return !name.empty() && std::any_of(tracks_.begin(), tracks_.end(), [&](const Track& track) {
    return track.semantic_class == SemanticClass::kZoneMarker && track.observations >= kWellKnown &&
           track.texts.best() == name;
  });
}

// Whose place a track has: its own, or the pillar's that a marker hangs on which was measured but
// once, from afar.
const ObjectRegistry::Track& ObjectRegistry::placedBy(const Track& track,
                                                      const std::vector<const Track*>& told) {
  if (track.semantic_class != SemanticClass::kZoneMarker || track.observations > 1) return track;
  const auto distance = [](const Track& a, const Track& b) {
    return (a.position - b.position).head<2>().norm();
  };
  const Track* nearest = nullptr;
  for (const Track* other : told) {
    if (other->semantic_class != SemanticClass::kPillar) continue;
    if (distance(*other, track) >= (nearest ? distance(*nearest, track) : kPillarNear)) continue;
    nearest = other;
  }
  if (nearest == nullptr) return track;
  const bool taken = std::any_of(told.begin(), told.end(), [&](const Track* other) {
    return other != &track && other->semantic_class == SemanticClass::kZoneMarker &&
           distance(*other, *nearest) < kPillarNear;
  });
  return taken ? track : *nearest;
}

// Their texts; what is written on zone markers, all of them together tell.
std::vector<std::string> ObjectRegistry::textsOf(const std::vector<const Track*>& told) {
  TextFormat format;
  for (const Track* track : told) {
    if (track->semantic_class != SemanticClass::kZoneMarker) continue;
    const std::string text = track->texts.best();
    if (!text.empty()) format.add(text);
  }
  std::vector<std::string> texts;
  std::vector<NamedMarker> markers;
  for (const Track* track : told) {
    const bool marker = track->semantic_class == SemanticClass::kZoneMarker;
    texts.push_back(marker ? track->texts.best(format) : track->texts.best());
    if (marker) markers.push_back({placedBy(*track, told).position.head<2>(), texts.back()});
  }
  nameByGrid(markers);
  auto named = markers.begin();
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (told[i]->semantic_class == SemanticClass::kZoneMarker) texts[i] = (named++)->text;
  }
  return texts;
}

}  // namespace parkade
