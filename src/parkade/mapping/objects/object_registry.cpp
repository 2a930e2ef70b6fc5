// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/object_registry.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "parkade/mapping/frame_evidence.hpp"
#include "parkade/mapping/map_check.hpp"

namespace parkade {
namespace {

constexpr double kGate = 16.27;  // 99.9 % of chi-square, 3 degrees

bool isSignClass(SemanticClass c) {
  return c == SemanticClass::kGuideSign || c == SemanticClass::kSpeedLimitSign;
}

// Followed over many pictures before it is told.
bool isFollowed(SemanticClass c) {
  return c == SemanticClass::kZoneMarker || isSignClass(c);
}

}  // namespace

bool ObjectRegistry::Track::isUpright() const {
  return roleOf(semantic_class) == LayerRole::kStructure;
}

bool ObjectRegistry::Track::isSign() const {
  return isSignClass(semantic_class);
}

bool ObjectRegistry::compatible(const Track& track, SemanticClass c, const Eigen::Vector3d& p,
                                double heading, bool has_heading) const {
  if (track.semantic_class != c) return false;
  if ((p - track.position).head<2>().norm() > options_.max_distance_m) return false;
  if (!has_heading || track.heading.norm() == 0.0) return true;
  // A pillar's faces carry the same text: only the one that looks the same way is the same marker.
  const Eigen::Vector2d direction(std::cos(heading), std::sin(heading));
  return direction.dot(track.heading) > 0.5 * track.heading.norm();
}

void ObjectRegistry::fuse(Track& track, const Eigen::Vector3d& p,
                          const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d S = track.covariance + covariance;
  const Eigen::Matrix3d K = S.llt().solve(track.covariance).transpose();
  track.position += K * (p - track.position);
  track.covariance = ((Eigen::Matrix3d::Identity() - K) * track.covariance).eval();
  track.covariance = (0.5 * (track.covariance + track.covariance.transpose())).eval();
}

// The track that an observation is of, of those not used yet; as many as there are where of none.
std::size_t ObjectRegistry::match(const ObjectObservation& o, double heading,
                                  const Eigen::Vector3d& p, const Eigen::Matrix3d& covariance,
                                  const std::vector<bool>& used) const {
  const double sigma2 = options_.association_sigma_m * options_.association_sigma_m;
  std::size_t best = tracks_.size();
  double best_distance = kGate;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] || !compatible(tracks_[i], o.semantic_class, p, heading, o.sigma_heading > 0.0)) {
      continue;
    }
    const Eigen::Matrix3d S =
        tracks_[i].covariance + covariance + sigma2 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d d = p - tracks_[i].position;
    const double distance = d.dot(S.llt().solve(d));
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = i;
  }
  return best;
}

void ObjectRegistry::update(const std::vector<ObjectObservation>& observations,
                            const SE2& T_world_vehicle, double z_vehicle, std::int64_t anchor,
                            const BevLabels* labels, const std::vector<LevelView>& views,
                            bool new_view) {
  way_.add(T_world_vehicle.translation(), anchor);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = T_world_vehicle.rotationMatrix();
  const double floor2 = options_.position_floor_m * options_.position_floor_m;
  std::vector<bool> used(tracks_.size(), false);
  for (const ObjectObservation& o : observations) {
    if (!new_view && !isFollowed(o.semantic_class)) continue;
    Eigen::Vector3d p;
    p << T_world_vehicle * o.position.head<2>(), o.position.z() + z_vehicle;
    const Eigen::Matrix3d covariance =
        R * o.covariance * R.transpose() + floor2 * Eigen::Matrix3d::Identity();
    const double heading = wrapAngle(o.heading + T_world_vehicle.angle());
    const bool has_heading = o.sigma_heading > 0.0;
    const std::size_t best = match(o, heading, p, covariance, used);
    if (best == tracks_.size()) {
      Track track;
      track.id = next_id_++;
      track.anchor = anchor;
      track.semantic_class = o.semantic_class;
      track.position = p;
      track.covariance = covariance;
      if (track.isSign()) lookBack(track);
      tracks_.push_back(track);
    } else {
      used[best] = true;
      fuse(tracks_[best], p, covariance);
    }
    Track& track = tracks_[best];
    if (has_heading) {
      const double weight = 1.0 / (o.sigma_heading * o.sigma_heading + 1e-4);
      track.heading += weight * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    }
    track.texts.add(o.text, o.confidence);
    if (!o.outline.empty() && o.confidence >= track.outline_confidence) {
      track.outline_confidence = o.confidence;
      track.outline.clear();
      for (const Eigen::Vector2d& q : o.outline) track.outline.push_back(T_world_vehicle * q);
    }
    ++track.observations;
  }
  if (!new_view) return;
  if (labels != nullptr) look(*labels, T_world_vehicle, used);
  for (const LevelView& view : views) {
    lookAcross(view, T_world_vehicle);
    lookUp({view, T_world_vehicle, z_vehicle, anchor});
  }
}

void ObjectRegistry::mergeDuplicates() {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    for (std::size_t j = tracks_.size() - 1; j > i; --j) {
      Track& a = tracks_[i];
      const Track& b = tracks_[j];
      // Most pairs are of two classes or lie far apart, which x tells at once.
      if (a.semantic_class != b.semantic_class ||
          std::abs(b.position.x() - a.position.x()) > options_.max_distance_m) {
        continue;
      }
      const double heading = std::atan2(b.heading.y(), b.heading.x());
      if (!compatible(a, b.semantic_class, b.position, heading, b.heading.norm() > 0.0)) continue;
      const Eigen::Vector3d d = b.position - a.position;
      const double sigma2 = options_.association_sigma_m * options_.association_sigma_m;
      const Eigen::Matrix3d S = a.covariance + b.covariance + sigma2 * Eigen::Matrix3d::Identity();
      if (d.dot(S.llt().solve(d)) > kGate) continue;
      fuse(a, b.position, b.covariance);
      a.heading += b.heading;
      a.texts.add(b.texts);
      a.observations += b.observations;
      a.existence.add(b.existence);
      a.in_views.add(b.in_views);
      a.votes.own += b.votes.own;
      a.votes.rival += b.votes.rival;
      a.votes.floor += b.votes.floor;
      if (b.outline_confidence > a.outline_confidence) {
        a.outline = b.outline;
        a.outline_confidence = b.outline_confidence;
      }
      tracks_.erase(tracks_.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }
}

void ObjectRegistry::moveWithAnchors(const std::function<SE2(std::int64_t)>& correction) {
  way_.moveWithAnchors(correction);
  for (Look& look : looks_) {
    look.T_world_vehicle = correction(look.anchor) * look.T_world_vehicle;
  }
  for (Track& track : tracks_) {
    const SE2 T = correction(track.anchor);
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    R.topLeftCorner<2, 2>() = T.rotationMatrix();
    track.position.head<2>() = T * track.position.head<2>();
    track.covariance = (R * track.covariance * R.transpose()).eval();
    track.heading = T.rotationMatrix() * track.heading;
    for (Eigen::Vector2d& q : track.outline) q = T * q;
  }
  mergeDuplicates();
}

void ObjectRegistry::raise(double dz) {
  for (Look& look : looks_) look.z_vehicle += dz;
  for (Track& track : tracks_) track.position.z() += dz;
}

double ObjectRegistry::existence(const Track& track) const {
  const double l = track.existence.logOdds(track.isUpright() ? options_.upright : options_.paint);
  if (track.semantic_class != SemanticClass::kPillar) return l;
  return l + options_.pillar_views.logOdds(track.in_views);
}

bool ObjectRegistry::exists(const Track& track) const {
  if (track.observations < (isFollowed(track.semantic_class) ? options_.min_marker_observations
                                                             : options_.min_observations)) {
    return false;
  }
  if (track.semantic_class == SemanticClass::kZoneMarker && isPhantom(track)) return false;
  // A limit without its number tells nothing; most of these are a zone marker's patch, misread.
  if (track.semantic_class == SemanticClass::kSpeedLimitSign && track.texts.best().empty()) {
    return false;
  }
  if (viewed_ && track.isSign()) {
    const ViewExistenceOptions& o = options_.sign_views;
    if (track.in_views.hits < o.min_hits || o.logOdds(track.in_views) <= 0.0) {
      return false;
    }
  }
  if (viewed_ && track.semantic_class == SemanticClass::kPillar &&
      track.in_views.hits < options_.pillar_views.min_hits) {
    return false;
  }
  if (!sighted_ || track.outline.empty()) return true;
  const double looks_alike = track.votes.own + track.votes.rival;
  return existence(track) > 0.0 && track.votes.own >= options_.min_own_share * looks_alike;
}

// Those that exist, none on another; ordered by id.
std::vector<const ObjectRegistry::Track*> ObjectRegistry::told() const {
  std::vector<const Track*> order;
  for (const Track& track : tracks_) {
    if (exists(track)) order.push_back(&track);
  }
  const auto rank = [this](const Track* track) {
    return isFollowed(track->semantic_class) ? static_cast<double>(track->observations)
                                             : existence(*track);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](const Track* a, const Track* b) { return rank(a) > rank(b); });
  std::vector<const Track*> told;
  for (const Track* track : order) {
    // Pillars stand farther apart; what lies that near behind one is its smear, and a marker that
    // bears the same text the same one, misplaced.
    constexpr double kPillarSpacing = 2.0;  // m
    const std::string text =
        track->semantic_class == SemanticClass::kZoneMarker ? track->texts.best() : std::string();
    const bool taken = std::any_of(told.begin(), told.end(), [&](const Track* other) {
      if (other->semantic_class != track->semantic_class) return false;
      const double distance = (other->position - track->position).head<2>().norm();
      return overlapShare(other->outline, track->outline) > options_.duplicate_overlap ||
             (track->isSign() && distance < options_.max_distance_m) ||
             (track->semantic_class == SemanticClass::kPillar && sighted_ &&
              distance < kPillarSpacing) ||
             (!text.empty() && distance < kPillarSpacing && other->texts.best() == text);
    });
    if (!taken) told.push_back(track);
  }
  std::stable_sort(told.begin(), told.end(),
                   [](const Track* a, const Track* b) { return a->id < b->id; });
  return told;
}

std::vector<MapObject> ObjectRegistry::objects() const {
  const std::vector<const Track*> tracks = told();
  const std::vector<std::string> texts = textsOf(tracks);
  std::vector<MapObject> result;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Track& track = *tracks[i];
    MapObject object;
    object.id = track.id;
    object.semantic_class = track.semantic_class;
    const Track& place = placedBy(track, tracks);
    object.position << place.position.head<2>(), track.position.z();
    object.heading =
        track.heading.norm() > 0.0 ? std::atan2(track.heading.y(), track.heading.x()) : 0.0;
    // Looks share the errors of calibration and pose, which many of them do not average out.
    object.position_sigma = std::hypot(std::sqrt(std::max(0.0, place.covariance.trace() / 3.0)),
                                       options_.position_floor_m);
    object.text = texts[i];
    object.outline = track.outline;
    object.observations = track.observations;
    result.push_back(std::move(object));
  }
  return result;
}

}  // namespace parkade
