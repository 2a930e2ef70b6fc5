// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/map_merge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "parkade/geometry/planar.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/frame_evidence.hpp"
#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/objects/object_registry.hpp"
#include "parkade/mapping/slots/slot_registry.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kSameSlot = 0.7;  // share of the smaller one's area
constexpr double kTouches = 0.15;  // less is how neighbours lie

struct SlotMatch {
  std::optional<std::size_t> at;  // in the saved map
  double overlap = 0.0;
};

SlotMatch matchSlot(const MapSlot& slot, const std::vector<MapSlot>& saved) {
  SlotMatch match;
  for (std::size_t i = 0; i < saved.size(); ++i) {
    constexpr double kReach = 8.0;  // m, beyond which no two slots touch
    if ((saved[i].entrance() - slot.entrance()).norm() > kReach) continue;
    const double overlap = overlapShare(slot.corners, saved[i].corners);
    if (overlap <= match.overlap) continue;
    match.overlap = overlap;
    if (overlap >= kSameSlot) match.at = i;
  }
  return match;
}

// The share of a mean that a measurement gets, by standard deviations.
double shareOf(double sigma, double other) {
  constexpr double kLeast = 0.005;  // m
  const double own = 1.0 / std::pow(std::max(kLeast, sigma), 2);
  return own / (own + 1.0 / std::pow(std::max(kLeast, other), 2));
}

// floor: what no number of looks is better than, as the registries tell.
double jointSigma(double a, double b, double floor) {
  return a > 0.0 && b > 0.0 ? std::max(floor, 1.0 / std::hypot(1.0 / a, 1.0 / b)) : std::max(a, b);
}

void takeText(const std::string& later, bool prevails, std::string& saved) {
  if (!later.empty() && (saved.empty() || prevails)) saved = later;
}

void mergeSlot(const MapSlot& later, MapSlot& saved) {
  // Entered from the same side, else the saved one's shape stays.
  constexpr double kSameCorner = 1.0;  // m
  const bool alike = (later.corners[0] - saved.corners[0]).norm() < kSameCorner &&
                     (later.corners[1] - saved.corners[1]).norm() < kSameCorner;
  if (alike && later.observations > 0) {
    const double share = shareOf(later.corner_sigma, saved.corner_sigma);
    for (std::size_t i = 0; i < 4; ++i) {
      saved.corners[i] += share * (later.corners[i] - saved.corners[i]);
    }
    saved.corner_sigma =
        jointSigma(later.corner_sigma, saved.corner_sigma, SlotRegistryOptions().corner_floor_m);
  }
  const bool prevails = later.observations > saved.observations;
  takeText(later.number, prevails, saved.number);
  takeText(later.zone, prevails, saved.zone);
  if (later.observations > 0 || later.isFree() || later.isOccupied()) {
    saved.probability_free = later.probability_free;
    saved.last_seen_ns = later.last_seen_ns;
  }
  saved.observations += later.observations;
}

// The maps are of one world if what both know lies on one another.
Status checkSameWorld(const std::vector<SlotMatch>& matches) {
  int known = 0;
  int same = 0;
  for (const SlotMatch& match : matches) {
    if (match.overlap <= 0.0) continue;
    ++known;
    same += match.at ? 1 : 0;
  }
  constexpr int kLeast = 3;
  constexpr double kShare = 0.6;
  if (same >= kLeast && same >= kShare * known) return {};
  return Error{fmt::format(
      "{} of the later map's {} slots lie on one of the saved map's, {} of them as the same slot: "
      "the maps are not of one world; was the later drive localised in the saved map?",
      known, matches.size(), same)};
}

std::int64_t nextId(const ParkingMap& map) {
  std::int64_t id = 0;
  for (const MapSlot& slot : map.slots) id = std::max(id, slot.id);
  for (const MapObject& object : map.objects) id = std::max(id, object.id);
  return id + 1;
}

// matches: of the later map's slots, in their order.
void mergeSlots(const ParkingMap& later, const std::vector<SlotMatch>& matches, ParkingMap& saved,
                MergeReport& report) {
  std::int64_t id = nextId(saved);
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const MapSlot& slot = later.slots[k];
    const SlotMatch& match = matches[k];
    if (match.at) {
      mergeSlot(slot, saved.slots[*match.at]);
      ++report.slots_again;
    } else if (match.overlap > kTouches) {
      ++report.slots_refused;
    } else {
      saved.slots.push_back(slot);
      saved.slots.back().id = id++;
      ++report.slots_new;
    }
  }
}

// Where no drive could tell how a painted limit is turned, its heading is 0.
bool hasHeading(const MapObject& object) {
  return object.semantic_class != SemanticClass::kSpeedLimitPaint || object.heading != 0.0;
}

bool sameObject(const MapObject& a, const MapObject& b) {
  constexpr double kDistance = 1.0;  // m
  constexpr double kTurn = 1.0;      // rad: a pillar's faces are markers of their own
  return a.semantic_class == b.semantic_class &&
         (a.position - b.position).head<2>().norm() < kDistance &&
         (!hasHeading(a) || !hasHeading(b) || std::abs(wrapAngle(a.heading - b.heading)) < kTurn);
}

void mergeObject(const MapObject& later, MapObject& saved) {
  const double share = shareOf(later.position_sigma, saved.position_sigma);
  const Eigen::Vector3d step = share * (later.position - saved.position);
  saved.position += step;
  for (Vector2d& corner : saved.outline) corner += step.head<2>();
  if (saved.outline.empty()) saved.outline = later.outline;
  if (!hasHeading(saved)) {
    saved.heading = later.heading;
  } else if (hasHeading(later)) {
    saved.heading = wrapAngle(saved.heading + share * wrapAngle(later.heading - saved.heading));
  }
  saved.position_sigma = jointSigma(later.position_sigma, saved.position_sigma,
                                    ObjectRegistryOptions().position_floor_m);
  takeText(later.text, later.observations > saved.observations, saved.text);
  saved.observations += later.observations;
}

void mergeObjects(const ParkingMap& later, ParkingMap& saved, MergeReport& report) {
  const std::size_t known = saved.objects.size();
  std::int64_t id = nextId(saved);
  for (const MapObject& object : later.objects) {
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < known; ++i) {
      if (!sameObject(object, saved.objects[i])) continue;
      const auto distance = [&](std::size_t k) {
        return (saved.objects[k].position - object.position).head<2>().norm();
      };
      if (!nearest || distance(i) < distance(*nearest)) nearest = i;
    }
    if (nearest) {
      mergeObject(object, saved.objects[*nearest]);
      ++report.objects_again;
    } else {
      saved.objects.push_back(object);
      saved.objects.back().id = id++;
      ++report.objects_new;
    }
  }
}

// Whether a point lies in an outline of any shape.
bool isInOutline(const std::vector<Vector2d>& outline, const Vector2d& p) {
  bool within = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d& a = outline[i];
    const Vector2d& b = outline[(i + 1) % outline.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    const bool is_left = cross(b - a, p - a) > 0.0;
    if (is_left == (b.y() > a.y())) within = !within;
  }
  return within;
}

// Whether a grid shows bare floor where a painted object would be. bounds: of its road markers.
bool showsFloorAt(const MapObject& object, const LayeredGrid& grid,
                  const LayeredGrid::Bounds& bounds) {
  constexpr double kHalf = 0.25;  // m, of the box that stands for an outline
  constexpr int kLeastKnown = 20;
  constexpr double kSeen = 0.6;
  constexpr double kFloor = 0.9;
  std::vector<Vector2d> outline = object.outline;
  if (outline.size() < 3) {
    const Vector2d p = object.position.head<2>();
    outline = {p + Vector2d(-kHalf, -kHalf), p + Vector2d(kHalf, -kHalf),
               p + Vector2d(kHalf, kHalf), p + Vector2d(-kHalf, kHalf)};
  }
  Vector2d low = outline.front();
  Vector2d high = low;
  for (const Vector2d& p : outline) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  low = low.cwiseMax(grid.centerOf(bounds.min));
  high = high.cwiseMin(grid.centerOf(bounds.max));
  if (!(low.x() <= high.x() && low.y() <= high.y())) return false;
  const Eigen::Vector2i from = grid.cellOf(low);
  const Eigen::Vector2i to = grid.cellOf(high);
  // A strip beside what stands on it now is bare whatever is painted there.
  const double all = std::abs(signedArea(outline)) / (grid.resolution() * grid.resolution());
  const int enough = std::max(kLeastKnown, static_cast<int>(kSeen * all));
  int known = 0;
  int floor = 0;
  for (int y = from.y(); y <= to.y(); ++y) {
    for (int x = from.x(); x <= to.x(); ++x) {
      const GridCell cell = grid.at(GridLayer::kRoadMarkers, {x, y});
      if (!cell.known() || !isInOutline(outline, grid.centerOf({x, y}))) continue;
      ++known;
      floor += cell.believed() == SemanticClass::kFloor ? 1 : 0;
    }
  }
  return known >= enough && floor >= kFloor * known;
}

// Of the first `known` of the saved map's objects, paint that the later drive saw to be gone.
void dropGone(const ParkingMap& later, std::size_t known, ParkingMap& saved, MergeReport& report) {
  const auto bounds = later.grid.bounds(GridLayer::kRoadMarkers);
  if (!bounds) return;
  const auto is_gone = [&](const MapObject& object) {
    return roleOf(object.semantic_class) == LayerRole::kRoadMarker &&
           object.semantic_class != SemanticClass::kSpeedBump &&
           std::none_of(later.objects.begin(), later.objects.end(),
                        [&](const MapObject& told) { return sameObject(told, object); }) &&
           showsFloorAt(object, later.grid, *bounds);
  };
  const auto end = saved.objects.begin() + static_cast<std::ptrdiff_t>(known);
  const auto gone = std::remove_if(saved.objects.begin(), end, is_gone);
  report.objects_gone = static_cast<int>(end - gone);
  saved.objects.erase(gone, end);
}

void mergeLayers(const LayeredGrid& later, LayeredGrid& saved) {
  for (const GridLayer layer : kGridLayers) {
    if (layer == GridLayer::kDynamic) continue;
    later.forEachKnown(layer, [&](const Eigen::Vector2i& cell, const GridCell& seen) {
      GridCell& kept = saved.touch(layer, cell);
      if (layer == GridLayer::kAvailability) {
        kept = seen;
      } else if (seen.log_odds > 0) {
        addEvidence(kept, seen.semantic_class, GridCell::kStep * static_cast<float>(seen.log_odds));
      }
    });
  }
}

}  // namespace

Result<MergeReport> mergeMap(const ParkingMap& later, ParkingMap& saved) {
  if (later.grid.resolution() != saved.grid.resolution()) {
    return Error{fmt::format("cells of {} m do not fit into a map of {} m", later.grid.resolution(),
                             saved.grid.resolution())};
  }
  std::vector<SlotMatch> matches;
  for (const MapSlot& slot : later.slots) matches.push_back(matchSlot(slot, saved.slots));
  if (Status status = checkSameWorld(matches); !status) return status.error();
  MergeReport report;
  mergeSlots(later, matches, saved, report);
  const std::size_t known = saved.objects.size();
  mergeObjects(later, saved, report);
  dropGone(later, known, saved, report);
  mergeLayers(later.grid, saved.grid);
  return report;
}

}  // namespace parkade
