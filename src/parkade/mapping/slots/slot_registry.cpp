// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/slot_registry.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "parkade/mapping/slots/slot_registry_impl.hpp"
#include "parkade/mapping/slots/slot_track.hpp"
#include "parkade/mapping/votes.hpp"

namespace parkade {

using slot_registry::areOne;
using slot_registry::logOdds;
using slot_registry::matchTracks;
using slot_registry::Matrix4;
using slot_registry::merged;
using slot_registry::Seen;
using slot_registry::showsEntrance;
using slot_registry::toWorld;
using slot_registry::Track;

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
  track.support += slot_registry::sharpness(seen.covariance) * seen.source->confidence;
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
  m.way.add(T_world_vehicle.translation(), anchor);
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
  impl_->way.moveWithAnchors(correction);
  impl_->numbers.moveWithAnchors(correction);
  impl_->of_rows.clear();
  impl_->replaced.clear();
  impl_->mergeDuplicates();
}

int SlotRegistry::candidates() const {
  return static_cast<int>(impl_->tracks.size());
}

}  // namespace parkade
