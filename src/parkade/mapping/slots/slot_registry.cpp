// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/slot_registry.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/slots/bay_numbers.hpp"
#include "parkade/mapping/slots/row_completion.hpp"
#include "parkade/mapping/slots/slot_numbers.hpp"
#include "parkade/mapping/slots/slot_plausibility.hpp"
#include "parkade/mapping/slots/slot_track.hpp"
#include "parkade/mapping/votes.hpp"

namespace parkade {

using slot_registry::areOne;
using slot_registry::Corners;
using slot_registry::logOdds;
using slot_registry::matchTracks;
using slot_registry::Matrix4;
using slot_registry::merged;
using slot_registry::Seen;
using slot_registry::showsEntrance;
using slot_registry::SlotNumber;
using slot_registry::SlotNumbers;
using slot_registry::toWorld;
using slot_registry::Track;

struct SlotRegistry::Impl {
  SlotRegistryOptions options;
  std::vector<Track> tracks;  // ordered by id
  std::int64_t next_id = 1;
  struct Place {
    Eigen::Vector2d p;
    std::int64_t anchor;
  };
  std::vector<Place> way;              // of the vehicle's origin
  std::vector<MapSlot> of_rows;        // that the rows have beside the tracks
  TimeNs completed_ns = 0;             // when they were told
  std::vector<std::int64_t> replaced;  // tracks in whose places those lie
  SlotNumbers numbers;

  explicit Impl(const SlotRegistryOptions& given)
      : options(given), numbers(given.min_number_readings, given.number_confidence) {}
  // What is left of what was known of a slot's availability then: cars come and go.
  [[nodiscard]] double fade(TimeNs then_ns, TimeNs now_ns) const {
    const double seconds = std::max(0.0, toSeconds(now_ns - then_ns));
    return std::exp(-seconds / options.change_time_s);
  }
  void judge(Track& track, const SlotObservation& seen, TimeNs t_ns) const;
  static void fuse(Track& track, const Seen& seen);
  void add(const Seen& seen, TimeNs t_ns, std::int64_t anchor);
  void countMisses(const SE2& T_world_vehicle, const BevLabels* labels,
                   const std::vector<bool>& was_seen);
  void forgetOdd();
  void mergeDuplicates();
  [[nodiscard]] std::vector<const Track*> distinct() const;
  [[nodiscard]] std::vector<Eigen::Vector2d> drivenWay() const {
    std::vector<Eigen::Vector2d> driven;
    for (const Place& place : way) driven.push_back(place.p);
    return driven;
  }
  [[nodiscard]] bool isPlausible(const MapSlot& slot, const std::vector<MapObject>& objects,
                                 const std::vector<Eigen::Vector2d>& driven) const;
  [[nodiscard]] std::vector<MapSlot> seenSlots(TimeNs now_ns,
                                               const std::vector<MapObject>& objects) const;
  [[nodiscard]] MapSlot ofRow(MapSlot slot, TimeNs now_ns) const;
  [[nodiscard]] bool told(const Track& track) const {
    // Seen rarely while in plain sight: something else.
    return track.observations >= options.min_observations &&
           track.misses <= 3 * track.observations + 5;
  }
};

// A view across the neighbours' ground says little once there was one over the entrance.
void SlotRegistry::Impl::judge(Track& track, const SlotObservation& seen, TimeNs t_ns) const {
  constexpr double kLimit = 5.0;
  constexpr double kAside = 0.05;  // what a view from aside alone is worth
  const double kept = fade(track.availability_ns, t_ns);
  const double best = std::max(kept * track.best_view, seen.seen_over_entrance);
  const double weight = (seen.seen_over_entrance + kAside) / (best + kAside);
  track.log_odds_free = std::clamp(kept * track.log_odds_free + weight * options.availability_gain *
                                                                    logOdds(seen.probability_free),
                                   -kLimit, kLimit);
  track.best_view = best;
  track.availability_ns = t_ns;
  track.last_seen_ns = t_ns;
}

void SlotRegistry::Impl::fuse(Track& track, const Seen& seen) {
  const Matrix4 S = track.covariance + seen.covariance;
  const Matrix4 K = S.llt().solve(track.covariance).transpose();
  track.entrance += K * (seen.entrance - track.entrance);
  track.covariance = ((Matrix4::Identity() - K) * track.covariance).eval();
  track.covariance = (0.5 * (track.covariance + track.covariance.transpose())).eval();
  constexpr double kGuess = 0.05;  // weight of rear corners that were completed, not seen
  const double weight = seen.source->rear_seen ? 1.0 : kGuess;
  const double share = weight / (track.rear_weight + weight);
  track.rear_left += share * (seen.rear_left - track.rear_left);
  track.rear_right += share * (seen.rear_right - track.rear_right);
  track.rear_weight += weight;
  ++track.observations;
  track.confidence += seen.source->confidence;
  track.shapes[static_cast<std::size_t>(seen.source->shape)] += seen.source->confidence;
}

void SlotRegistry::Impl::add(const Seen& seen, TimeNs t_ns, std::int64_t anchor) {
  Track track;
  track.id = next_id++;
  track.anchor = anchor;
  track.entrance = seen.entrance;
  track.covariance = seen.covariance;
  track.rear_left = seen.rear_left;
  track.rear_right = seen.rear_right;
  track.availability_ns = t_ns;
  tracks.push_back(track);
  Track& added = tracks.back();
  const Matrix4 own = added.covariance;
  fuse(added, seen);
  judge(added, *seen.source, t_ns);
  added.covariance = own;  // one observation counts once
}

// Of the tracks that were there before: plain sight is near the car, and where there are labels, in
// which the ground at the entrance is seen.
void SlotRegistry::Impl::countMisses(const SE2& T_world_vehicle, const BevLabels* labels,
                                     const std::vector<bool>& was_seen) {
  const SE2 T_vehicle_world = T_world_vehicle.inverse();
  for (std::size_t i = 0; i < was_seen.size(); ++i) {
    constexpr double kPlainSight = 4.0;
    if (was_seen[i] || (T_vehicle_world * tracks[i].middle()).norm() >= kPlainSight) continue;
    if (labels == nullptr || showsEntrance(*labels, T_vehicle_world, tracks[i])) ++tracks[i].misses;
  }
}

// What was seen once and then not again while in plain sight, on a slot that is known better.
void SlotRegistry::Impl::forgetOdd() {
  constexpr int kMisses = 5;
  const auto odd = [&](const Track& track) {
    return track.observations == 1 && track.misses >= kMisses;
  };
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(), odd), tracks.end());
}

// Those told, ordered by id; of several on one place the one that explains more of what was seen.
std::vector<const Track*> SlotRegistry::Impl::distinct() const {
  std::vector<const Track*> order;
  for (const Track& track : tracks) {
    if (told(track)) order.push_back(&track);
  }
  const auto merit = [](const Track* track) {
    return track->confidence - 0.5 * static_cast<double>(track->misses);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](const Track* a, const Track* b) { return merit(a) > merit(b); });
  constexpr double kLargest = 8.0;  // m
  std::vector<const Track*> chosen;
  for (const Track* track : order) {
    const bool taken = std::any_of(chosen.begin(), chosen.end(), [&](const Track* other) {
      return (track->centre() - other->centre()).norm() < kLargest &&
             overlapShare(track->corners(), other->corners()) > options.duplicate_overlap;
    });
    if (!taken) chosen.push_back(track);
  }
  std::sort(chosen.begin(), chosen.end(),
            [](const Track* a, const Track* b) { return a->id < b->id; });
  return chosen;
}

void SlotRegistry::Impl::mergeDuplicates() {
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (std::size_t j = tracks.size() - 1; j > i; --j) {
      if (!areOne(tracks[i], tracks[j], options.duplicate_overlap)) continue;
      tracks[i] = merged(std::move(tracks[i]), std::move(tracks[j]));
      tracks.erase(tracks.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }
}

SlotRegistry::SlotRegistry(const SlotRegistryOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
SlotRegistry::~SlotRegistry() = default;
SlotRegistry::SlotRegistry(SlotRegistry&&) noexcept = default;
SlotRegistry& SlotRegistry::operator=(SlotRegistry&&) noexcept = default;

void SlotRegistry::update(const std::vector<SlotObservation>& observations, TimeNs t_ns,
                          const SE2& T_world_vehicle, std::int64_t anchor, bool new_view,
                          const BevLabels* labels) {
  Impl& m = *impl_;
  constexpr double kStep = 0.1;  // m
  const Eigen::Vector2d place = T_world_vehicle.translation();
  if (m.way.empty() || (place - m.way.back().p).norm() >= kStep) m.way.push_back({place, anchor});
  std::vector<Seen> all;
  for (const SlotObservation& o : observations) {
    if (new_view && !o.number.empty()) {
      m.numbers.add(o.number, T_world_vehicle * o.number_place, anchor);
    }
    all.push_back(toWorld(o, T_world_vehicle, m.options.corner_floor_m));
  }
  // Chi-square of 4 degrees by its normal form; the registry may not see the filter's table.
  const std::vector<std::optional<std::size_t>> matches = matchTracks(
      m.tracks, all, m.options.association_sigma_m, chiSquareGate4(m.options.gate_probability));
  std::vector<bool> was_seen(m.tracks.size(), false);
  for (std::size_t j = 0; j < all.size(); ++j) {
    if (!matches[j]) continue;
    was_seen[*matches[j]] = true;
    Track& track = m.tracks[*matches[j]];
    if (new_view) Impl::fuse(track, all[j]);
    m.judge(track, *all[j].source, t_ns);
  }
  // Errors of one view come again, whatever was seen of a slot or was not: cars alone come and go.
  if (!new_view) return;
  // What lies on a known slot may be that slot seen badly, or the other way round: both are kept
  // until slots() has to choose.
  for (std::size_t j = 0; j < all.size(); ++j) {
    if (!matches[j]) m.add(all[j], t_ns, anchor);
  }
  m.countMisses(T_world_vehicle, labels, was_seen);
  m.forgetOdd();
}

void SlotRegistry::moveWithAnchors(const std::function<SE2(std::int64_t)>& correction) {
  for (Track& track : impl_->tracks) {
    const SE2 T = correction(track.anchor);
    const Eigen::Matrix2d R = T.rotationMatrix();
    const Eigen::Vector2d left = T * track.entrance.head<2>();
    const Eigen::Vector2d right = T * track.entrance.tail<2>();
    track.entrance << left, right;
    track.rear_left = R * track.rear_left;
    track.rear_right = R * track.rear_right;
    Matrix4 turn = Matrix4::Zero();
    turn.topLeftCorner<2, 2>() = R;
    turn.bottomRightCorner<2, 2>() = R;
    track.covariance = (turn * track.covariance * turn.transpose()).eval();
  }
  for (Impl::Place& place : impl_->way) place.p = correction(place.anchor) * place.p;
  impl_->numbers.moveWithAnchors(correction);
  impl_->of_rows.clear();
  impl_->replaced.clear();
  impl_->mergeDuplicates();
}

int SlotRegistry::candidates() const {
  return static_cast<int>(impl_->tracks.size());
}

bool SlotRegistry::Impl::isPlausible(const MapSlot& slot, const std::vector<MapObject>& objects,
                                     const std::vector<Eigen::Vector2d>& driven) const {
  return !drivenThrough(slot.corners, driven) && !holdsRoadMarking(slot.corners, objects) &&
         !holdsPillar(slot.corners, objects, slot.observations);
}

std::vector<MapSlot> SlotRegistry::Impl::seenSlots(TimeNs now_ns,
                                                   const std::vector<MapObject>& objects) const {
  const std::vector<Eigen::Vector2d> driven = drivenWay();
  std::vector<MapSlot> seen;
  for (const Track* track : distinct()) {
    if (std::find(replaced.begin(), replaced.end(), track->id) != replaced.end()) continue;
    MapSlot slot;
    slot.id = track->id;
    slot.corners = track->corners();
    slot.corner_sigma = std::sqrt(std::max(0.0, track->covariance.trace() / 4.0));
    slot.shape = static_cast<SlotShape>(
        std::max_element(track->shapes.begin(), track->shapes.end()) - track->shapes.begin());
    slot.probability_free =
        1.0 / (1.0 + std::exp(-fade(track->availability_ns, now_ns) * track->log_odds_free));
    slot.observations = track->observations;
    slot.last_seen_ns = track->last_seen_ns;
    if (isPlausible(slot, objects, driven)) seen.push_back(std::move(slot));
  }
  return seen;
}

// As it is told now: what the layers show of a filling is as old as what was seen of its neighbour.
MapSlot SlotRegistry::Impl::ofRow(MapSlot slot, TimeNs now_ns) const {
  const TimeNs then_ns = slot.observations > 0 ? completed_ns : slot.last_seen_ns;
  if (now_ns <= then_ns) return slot;
  const double log_odds = std::log(slot.probability_free / (1.0 - slot.probability_free));
  slot.probability_free = 1.0 / (1.0 + std::exp(-fade(then_ns, now_ns) * log_odds));
  return slot;
}

namespace {

// Slots stay told that only a filling which was refused would have replaced. seen: those told;
// added: the fillings that were not refused.
void keepBeatenByNone(const std::vector<MapSlot>& seen, const std::vector<MapSlot>& refused,
                      const std::vector<MapSlot>& added, std::vector<std::int64_t>& replaced) {
  constexpr double kTouches = 0.15;  // less is how neighbours lie
  const auto liesOn = [](const MapSlot& slot, const std::vector<MapSlot>& others) {
    return std::any_of(others.begin(), others.end(), [&](const MapSlot& other) {
      return overlapShare(slot.corners, other.corners) > kTouches;
    });
  };
  for (const MapSlot& slot : seen) {
    if (liesOn(slot, refused) && !liesOn(slot, added)) std::erase(replaced, slot.id);
  }
}

}  // namespace

void SlotRegistry::completeRows(TimeNs now_ns, const std::vector<MapObject>& objects,
                                const LayeredGrid& grid) {
  Impl& m = *impl_;
  const std::vector<Eigen::Vector2d> driven = m.drivenWay();
  const std::vector<MapSlot> before = std::exchange(m.of_rows, {});
  m.replaced.clear();
  m.completed_ns = now_ns;
  const std::vector<MapSlot> seen = m.seenSlots(now_ns, objects);
  RowCompletion rows = parkade::completeRows(seen, objects, grid, m.options.rows);
  m.replaced = std::move(rows.replaced);
  std::vector<MapSlot> refused;
  for (MapSlot& slot : rows.added) {
    if (!m.isPlausible(slot, objects, driven)) {
      std::erase(m.replaced, slot.id);  // what was told and cannot be moved stays as it is
      if (slot.id == 0) refused.push_back(slot);
      continue;
    }
    const auto same = std::find_if(before.begin(), before.end(), [&](const MapSlot& other) {
      constexpr double kSame = 0.5;
      return overlapShare(slot.corners, other.corners) > kSame &&
             std::none_of(m.of_rows.begin(), m.of_rows.end(),
                          [&](const MapSlot& given) { return given.id == other.id; });
    });
    if (slot.id == 0) slot.id = same != before.end() ? same->id : m.next_id++;
    m.of_rows.push_back(slot);
  }
  keepBeatenByNone(seen, refused, m.of_rows, m.replaced);
}

std::vector<MapSlot> SlotRegistry::slots(TimeNs now_ns,
                                         const std::vector<MapObject>& objects) const {
  std::vector<MapSlot> result = impl_->seenSlots(now_ns, objects);
  for (const MapSlot& slot : impl_->of_rows) {
    const auto taken = [&](const MapSlot& other) {
      return overlapShare(slot.corners, other.corners) > impl_->options.duplicate_overlap;
    };
    if (std::none_of(result.begin(), result.end(), taken)) {
      result.push_back(impl_->ofRow(slot, now_ns));
    }
  }
  std::sort(result.begin(), result.end(),
            [](const MapSlot& a, const MapSlot& b) { return a.id < b.id; });
  std::vector<std::optional<SlotNumber>> numbers;
  for (MapSlot& slot : result) {
    // Looks share the errors of calibration and pose: many of them know corners no better than
    // that.
    if (slot.observations > 0) {
      slot.corner_sigma = std::hypot(slot.corner_sigma, impl_->options.corner_floor_m);
    }
    numbers.push_back(impl_->numbers.within(slot.corners));
    const Corners& c = slot.corners;
    const Eigen::Vector2d centre = 0.25 * (c[0] + c[1] + c[2] + c[3]);
    double nearest = impl_->options.zone_range_m;
    for (const MapObject& object : objects) {
      if (object.semantic_class != SemanticClass::kZoneMarker || object.text.empty()) continue;
      const double distance = (object.position.head<2>() - centre).norm();
      if (distance >= nearest) continue;
      nearest = distance;
      slot.zone = object.text;
    }
  }
  keepSurestNumbers(numbers);
  std::vector<double> support(result.size(), 0.0);
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (!numbers[i]) continue;
    result[i].number = numbers[i]->text;
    support[i] = numbers[i]->support;
  }
  slot_registry::numberBays(result, support);
  return result;
}

}  // namespace parkade
