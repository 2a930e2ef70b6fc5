// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/core/log.hpp"
#include "parkade/core/units.hpp"
#include "parkade/pipeline/fused_mapper_impl.hpp"
#include "parkade/pipeline/shared_noise.hpp"

namespace parkade {
namespace {

// Enters what one stretch's submap holds in another, which lies at T_all_submap.
void gather(const Submap& submap, const SE2& T_all_submap, Submap& all) {
  const Eigen::Matrix2d R = T_all_submap.rotationMatrix();
  for (const LineFeature& line : submap.lines().features()) {
    constexpr int kTwice = 2;  // what one picture alone shows may be anything
    if (line.count < kTwice) continue;
    LinePoint point;
    point.p_level = T_all_submap * line.p;
    point.normal = R * line.normal;
    point.sigma = 1.0 / std::sqrt(line.weight);
    point.semantic_class = line.semantic_class;
    all.addLine(point);
  }
  for (PointFeature landmark : submap.points()) {
    landmark.p = T_all_submap * landmark.p;
    landmark.covariance = (R * landmark.covariance * R.transpose()).eval();
    all.addPoint(landmark);
  }
}

// A search tells the place no better than this.
Eigen::Matrix3d foundInformation(const Registration& fit, const SavedMapOptions& options) {
  return withSharedNoise(fit.information,
                         sharedNoise(options.found_sigma_m, options.found_sigma_deg));
}

}  // namespace

Surroundings FusedMapper::Impl::surroundings(const View& view) const {
  Surroundings result;
  Submap all;
  const SE2 T_vehicle_world = poseOf(view).inverse();
  std::vector<Eigen::Vector2d> middles;
  for (const Stretch& s : stretches) {
    const bool is_open = &s == &stretches.back();
    if (!is_open && view.travelled - s.end_m > options.saved_map.gathered_m) continue;
    if (s.begin_m < saved->lost_at) continue;  // how it lies to the rest nobody knows
    if (s.submap.frames() == 0) continue;
    gather(s.submap, T_vehicle_world * placeOf(s), all);
    middles.push_back(placeOf(s) * s.submap.middle());
  }
  result.features = asFrame(all);
  const auto isNear = [&](const Eigen::Vector2d& p) {
    constexpr double kReach = 10.0;  // m, about as far as a picture shows
    return std::any_of(middles.begin(), middles.end(),
                       [&](const Eigen::Vector2d& q) { return (p - q).norm() < kReach; });
  };
  const std::vector<MapObject> things = objects.objects();
  for (const MapSlot& slot : slots.slots(last_t_ns, things)) {
    if (isNear(slot.entrance())) result.slots.push_back(T_vehicle_world * slotFrame(slot.corners));
  }
  for (const MapObject& object : things) {
    if (object.semantic_class != SemanticClass::kArrow || !isNear(object.position.head<2>())) {
      continue;
    }
    result.arrows.push_back(T_vehicle_world * SE2(object.heading, object.position.head<2>()));
  }
  return result;
}

void FusedMapper::Impl::locate(const SemanticFrame& frame, const View& view) {
  const SavedMapOptions& o = options.saved_map;
  if (located() && !saved->lost) {
    registerToSavedMap(frame, view);
    if (!saved->told) {
      confirmPlace(view);
      return;
    }
    // No picture is laid on a map from farther off than searches reach, ever again.
    const Eigen::Matrix4d P = filter.relativeCovariance(saved->place, view.anchor);
    if (3.0 * largestSigma(P.topLeftCorner<2, 2>()) > options.loop.max_search_m) {
      lose(view);
      return;
    }
    // Beyond the map nothing fits either, and what looks alike there is another place.
    if (view.travelled - saved->confirmed_at <= o.give_up_m || !isMapped(view)) return;
  }
  if (view.travelled - saved->lost_at < o.least_m ||
      view.travelled - saved->last_search < o.every_m) {
    return;
  }
  saved->last_search = view.travelled;
  searchSavedMap(view);
}

void FusedMapper::Impl::searchSavedMap(const View& view) {
  const SavedMapOptions& o = options.saved_map;
  const LoopResult found =
      findInMap(surroundings(view), saved->map, o.search, options.registration);
  saved->reason = found.reason;
  if (!found.accepted) {
    logDebug("saved map, after {:.0f} m: {}", view.travelled, found.reason);
    return;
  }
  const SE2& T_map_vehicle = found.registration.T_map_vehicle;
  const SE2 T_map_world = T_map_vehicle * poseOf(view).inverse();
  // A second search, on what is partly new, has to say the same.
  const std::optional<SE2> before = std::exchange(saved->T_map_world, T_map_world);
  if (!before) return;
  const double agree = o.agree_deg * kDegree;
  if (!samePlace(T_map_vehicle, *before * poseOf(view), o.agree_m, agree)) return;
  if (located()) {
    if (saved->lost && comeBack(found.registration, view)) return;
    if (samePlace(T_map_vehicle, between(saved->place, view), o.agree_m, agree)) return;
    logInfo("another place in the saved map after {:.0f} m", view.travelled);
    givePlaceUp("it was another place");
  }
  settleInSavedMap(found.registration, view);
}

// The way until now stays where pictures held it to the map.
void FusedMapper::Impl::lose(const View& view) {
  saved->lost = saved->gone = true;
  saved->told = false;
  saved->lost_at = view.travelled;
  saved->T_map_world.reset();
  saved->reason = "the odometry lost the place";
  logInfo("lost in the saved map after {:.0f} m", view.travelled);
}

bool FusedMapper::Impl::comeBack(const Registration& fit, const View& view) {
  constexpr double kGate = 0.999999;  // two searches say the same
  const SavedMapOptions& o = options.saved_map;
  const FilterUpdate update = filter.updateBetween(saved->place, view.anchor, fit.T_map_vehicle,
                                                   foundInformation(fit, o), kGate);
  if (!update.accepted) return false;
  saved->lost = false;
  saved->found_at = saved->confirmed_at = view.travelled;
  corrected = true;
  return true;
}

void FusedMapper::Impl::givePlaceUp(const std::string& reason) {
  filter.removeAnchor(saved->place);
  saved->place = -1;
  saved->told = saved->lost = false;
  saved->T_map_world.reset();
  saved->reason = reason;
}

bool FusedMapper::Impl::isMapped(const View& view) const {
  constexpr double kNear = 10.0;  // m, about as far as a picture shows
  const Eigen::Vector2d p = between(saved->place, view).translation();
  if (saved->map.way.empty()) return true;  // who knows
  return std::any_of(saved->map.way.begin(), saved->map.way.end(),
                     [&](const Eigen::Vector3d& q) { return (q.head<2>() - p).norm() < kNear; });
}

void FusedMapper::Impl::rebase(const SE2& T_new_world, double dz) {
  filter.rebase(T_new_world, dz);
  for (Stretch& s : stretches) {
    s.pose.T_world_vehicle = T_new_world * s.pose.T_world_vehicle;
    s.pose.z += dz;
  }
  objects.raise(dz);
  compass.turnWorld(T_new_world.angle());
}

void FusedMapper::Impl::settleInSavedMap(const Registration& fit, const View& view) {
  const double z = saved->map.heightAt(fit.T_map_vehicle.translation());
  rebase(fit.T_map_vehicle * poseOf(view).inverse(), z - filter.anchor(view.anchor).z);
  // What it is known to beforehand: nothing, beside what the registration tells.
  constexpr double kAnywhere = 100.0;  // m, and rad
  saved->place = filter.addPlace({}, kAnywhere * Eigen::Matrix4d::Identity());
  const SavedMapOptions& o = options.saved_map;
  filter.updateBetween(saved->place, view.anchor, fit.T_map_vehicle, foundInformation(fit, o),
                       options.submaps.gate_probability);
  // The map's car stood that high, at the nearest place of its way.
  constexpr double kNearestPlace = 0.1;  // m
  filter.updateHeight(saved->place, z, kNearestPlace, options.submaps.gate_probability,
                      view.anchor);
  saved->found_at = saved->confirmed_at = view.travelled;
  corrected = true;
}

// A search finds the right place before it lies right in it, where paint is worn.
void FusedMapper::Impl::confirmPlace(const View& view) {
  const SavedMapOptions& o = options.saved_map;
  const Eigen::Matrix4d P = filter.relativeCovariance(saved->place, view.anchor);
  if (largestSigma(P.topLeftCorner<2, 2>()) < o.told_sigma_m) {
    saved->told = true;
    logInfo("found in the saved map after {:.0f} m", view.travelled);
  } else if (view.travelled - saved->found_at > o.give_up_m) {
    givePlaceUp("no frame confirms the place that was found");
  }
}

void FusedMapper::Impl::registerToSavedMap(const SemanticFrame& frame, const View& view) {
  ++statistics.map_registrations;
  const Registration fit =
      registerAround(frame, saved->map.landmarks, between(saved->place, view),
                     filter.relativeCovariance(saved->place, view.anchor), true);
  if (!fit.accepted) {
    logDebug("registration to the saved map: {}", fit.reason);
    return;
  }
  // The map's own errors stay the same over metres, whatever number of frames measure them.
  constexpr double kAlike = 10.0;  // m
  const double uses = std::max(1.0, kAlike / std::max(0.1, options.submaps.register_distance_m));
  const SavedMapOptions& o = options.saved_map;
  const Eigen::Matrix3d information =
      withSharedNoise(fit.information, uses * sharedNoise(o.sigma_m, o.sigma_deg));
  const FilterUpdate update = filter.updateBetween(saved->place, view.anchor, fit.T_map_vehicle,
                                                   information, options.submaps.gate_probability);
  if (!update.accepted) {
    ++statistics.refused_by_gate;
    return;
  }
  corrected = true;
  saved->confirmed_at = view.travelled;
  saved->T_map_world.reset();  // nothing else is looked for
  ++statistics.map_accepted;
}

}  // namespace parkade
