// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/slot_track.hpp"

#include <Eigen/Cholesky>
#include <utility>

#include "parkade/core/nearest_first.hpp"
#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/objects/label_sight.hpp"

namespace parkade::slot_registry {
namespace {

// Same direction to within 25 degrees and middles nearer than half a width: no neighbour does that.
bool mayBeSame(const Track& track, const Seen& seen) {
  const Eigen::Vector2d a = track.entrance.tail<2>() - track.entrance.head<2>();
  const Eigen::Vector2d b = seen.entrance.tail<2>() - seen.entrance.head<2>();
  constexpr double kCosine = 0.906;
  if (a.dot(b) < kCosine * a.norm() * b.norm()) return false;
  const Eigen::Vector2d middle = 0.5 * (seen.entrance.head<2>() + seen.entrance.tail<2>());
  return (middle - track.middle()).norm() < 0.45 * std::min(a.norm(), b.norm());
}

}  // namespace

Seen toWorld(const SlotObservation& o, const SE2& T, double floor) {
  Seen seen;
  seen.source = &o;
  const Eigen::Vector2d left = T * o.corners[0];
  const Eigen::Vector2d right = T * o.corners[1];
  seen.entrance << left, right;
  seen.rear_right = T * o.corners[2] - right;
  seen.rear_left = T * o.corners[3] - left;
  Matrix4 R = Matrix4::Zero();
  R.topLeftCorner<2, 2>() = T.rotationMatrix();
  R.bottomRightCorner<2, 2>() = T.rotationMatrix();
  seen.covariance = R * o.entrance_covariance * R.transpose() + floor * floor * Matrix4::Identity();
  return seen;
}

double sharpness(const Matrix4& covariance) {
  constexpr double kSharp = 0.03;  // m
  constexpr double kBlurred = 0.05;
  const double variance = std::max(0.5 * covariance.topLeftCorner<2, 2>().trace(),
                                   0.5 * covariance.bottomRightCorner<2, 2>().trace());
  return (kBlurred * kBlurred + kSharp * kSharp) / (kBlurred * kBlurred + variance);
}

std::vector<std::optional<std::size_t>> matchTracks(const std::vector<Track>& tracks,
                                                    const std::vector<Seen>& all, double sigma,
                                                    double gate) {
  std::vector<TrackPair> pairs;
  for (std::size_t j = 0; j < all.size(); ++j) {
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      if (!mayBeSame(tracks[i], all[j])) continue;
      const Matrix4 S =
          tracks[i].covariance + all[j].covariance + sigma * sigma * Matrix4::Identity();
      const Vector4 d = all[j].entrance - tracks[i].entrance;
      const double distance = d.dot(S.llt().solve(d));
      if (distance < gate) pairs.push_back({distance, i, j});
    }
  }
  return matchNearestFirst(std::move(pairs), tracks.size(), all.size());
}

bool showsEntrance(const BevLabels& labels, const SE2& T_vehicle_world, const Track& track) {
  constexpr double kRange = 8.5;  // m
  constexpr double kHalf = 0.15;  // m, of the square that is looked at
  constexpr double kMostHidden = 0.2;
  const LabelSight sight(labels, kRange);
  const Eigen::Vector2d left = track.entrance.head<2>();
  const Eigen::Vector2d right = track.entrance.tail<2>();
  for (const Eigen::Vector2d& p : {left, track.middle(), right}) {
    const Eigen::Vector2d at = T_vehicle_world * p;
    const AreaShares shares =
        sight.of({at + Eigen::Vector2d(-kHalf, -kHalf), at + Eigen::Vector2d(kHalf, -kHalf),
                  at + Eigen::Vector2d(kHalf, kHalf), at + Eigen::Vector2d(-kHalf, kHalf)},
                 SemanticClass::kFloor);
    if (shares.unseen + shares.covered > kMostHidden) return false;
  }
  return true;
}

bool areOne(const Track& a, const Track& b, double duplicate_overlap) {
  constexpr double kSame = 0.6;  // m, corners of one entrance
  // Most pairs lie far apart, which x tells at once.
  if (std::abs(b.entrance[0] - a.entrance[0]) > kSame) return false;
  // Another reading of the place stays one: the registry weighs them.
  const Vector4 d = b.entrance - a.entrance;
  if (d.head<2>().norm() > kSame || d.tail<2>().norm() > kSame) return false;
  return overlapShare(a.corners(), b.corners()) >= duplicate_overlap;
}

Track merged(Track first, Track second) {
  const std::int64_t id = first.id;
  if (second.observations > first.observations) std::swap(first, second);
  first.id = id;
  const Eigen::Vector2d a = first.entrance.tail<2>() - first.entrance.head<2>();
  const Eigen::Vector2d b = second.entrance.tail<2>() - second.entrance.head<2>();
  if (a.dot(b) > 0.9 * a.norm() * b.norm()) {
    const Matrix4 K =
        (first.covariance + second.covariance).llt().solve(first.covariance).transpose();
    first.entrance += K * (second.entrance - first.entrance);
    first.covariance = ((Matrix4::Identity() - K) * first.covariance).eval();
    first.covariance = (0.5 * (first.covariance + first.covariance.transpose())).eval();
  }
  if (second.availability_ns > first.availability_ns) {
    first.log_odds_free = second.log_odds_free;
    first.best_view = second.best_view;
    first.availability_ns = second.availability_ns;
  }
  first.last_seen_ns = std::max(first.last_seen_ns, second.last_seen_ns);
  first.observations += second.observations;
  first.misses += second.misses;
  first.support += second.support;
  for (std::size_t k = 0; k < first.shapes.size(); ++k) first.shapes[k] += second.shapes[k];
  return first;
}

}  // namespace parkade::slot_registry
