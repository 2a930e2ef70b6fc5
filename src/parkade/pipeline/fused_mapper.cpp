// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/fused_mapper.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/core/units.hpp"
#include "parkade/mapping/layers/told_layers.hpp"
#include "parkade/mapping/objects/painted_arrows.hpp"
#include "parkade/mapping/objects/painted_crossings.hpp"
#include "parkade/pipeline/fused_mapper_impl.hpp"

namespace parkade {
PoseEstimate FusedMapper::Impl::estimate() const {
  PoseEstimate e = *odometry;
  if (e.health == Health::kInitialising) return e;
  const GroundPose& pose = filter.pose();
  const double turn = pose.T_world_vehicle.angle() - odometry->T_odom_vehicle.rotation().yaw();
  e.T_odom_vehicle = liftPose(pose.T_world_vehicle, pose.z, odometry->T_odom_vehicle);
  e.velocity_odom = SO3::fromYawPitchRoll(turn, 0.0, 0.0) * odometry->velocity_odom;
  // Place, height and heading are the filter's; pitch and roll the odometry's own.
  const Eigen::Matrix3d R_level =
      SO3::fromYawPitchRoll(-pose.T_world_vehicle.angle(), 0.0, 0.0).matrix() *
      e.T_odom_vehicle.rotation().matrix();
  Matrix6d to_level = Matrix6d::Zero();
  to_level.topLeftCorner<3, 3>() = R_level;
  to_level.bottomRightCorner<3, 3>() = R_level;
  Matrix6d level = to_level * odometry->covariance.topLeftCorner<6, 6>() * to_level.transpose();
  const Eigen::Matrix4d P =
      located() ? filter.relativeCovariance(saved->place) : filter.covariance();
  constexpr int kAt[4] = {0, 1, 5, 2};  // x, y, angle, z
  for (const int i : kAt) {
    level.row(i).setZero();
    level.col(i).setZero();
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) level(kAt[i], kAt[j]) = P(i, j);
  }
  e.covariance.topLeftCorner<6, 6>() = to_level.transpose() * level * to_level;
  if (saved && !saved->told) {
    e.health = Health::kInitialising;
    e.reason =
        "not yet found in the saved map" + (saved->reason.empty() ? "" : ": " + saved->reason);
  }
  return e;
}

void FusedMapper::Impl::predict(const PoseEstimate& now) {
  if (now.health == Health::kInitialising) return;
  if (!tracked) {
    constexpr double kStart = 1e-8;  // the world frame is where the first pose says
    filter = PoseFilter({SE2::fromSE3(now.T_odom_vehicle), now.T_odom_vehicle.translation().z()},
                        kStart * Eigen::Matrix4d::Identity());
    tracked = now;
    return;
  }
  // After a start of its own the odometry goes on in its frame, as unsure as it then is.
  OdometryNoiseOptions noise = options.odometry;
  if (odometry->health == Health::kInitialising) {
    rows.forget();
    compass_scatter = CompassScatter(options.compass.sigma_deg * kDegree);
    noise.told_share = std::max(1.0, noise.told_share);
  }
  const PlanarIncrement step = planarIncrement(*tracked, now, noise);
  tracked = now;
  filter.predict(step.T_before_after, step.dz, step.covariance);
  travelled += step.T_before_after.translation().norm();
  turned += std::abs(step.T_before_after.angle());
}

void FusedMapper::Impl::hold() {
  views.push_back({filter.addAnchor(), *odometry, travelled, turned, history.size() - 1});
}

void FusedMapper::Impl::beginStretch(const View& view) {
  if (!stretches.empty()) open().end_m = view.travelled;
  Stretch stretch;
  stretch.anchor = view.anchor;
  stretch.t_ns = view.odometry.t_ns;
  stretch.begin_m = view.travelled;
  stretch.pose = filter.anchor(view.anchor);
  stretch.applied = stretch.pose.T_world_vehicle;
  stretch.rig_turn = rig_turn;
  stretch.T_odom_vehicle = view.odometry.T_odom_vehicle;
  history.beginAnchor(view.anchor, view.at);
  if (!stretches.empty()) {
    PoseGraphEdge edge;
    edge.from = open().anchor;
    edge.to = stretch.anchor;
    edge.T_from_to = open().T_odom_vehicle.inverse() * stretch.T_odom_vehicle;
    const double way = std::max(0.1, stretch.begin_m - open().begin_m);
    const double place = options.odometry.translation * options.odometry.translation * way;
    const double turn = std::pow(options.odometry.yaw_deg * kDegree, 2) * way;
    edge.information.diagonal() << 1.0 / place, 1.0 / place, 1.0 / place, 1.0 / turn, 1.0 / turn,
        1.0 / turn;
    edges.push_back(edge);
  }
  global.setAnchor(stretch.anchor, stretch.applied);
  stretches.push_back(std::move(stretch));
  turned_at_stretch = view.turned;
  ++statistics.anchors;
  if (static_cast<int>(filter.anchors().size()) > options.submaps.max_anchors) {
    const auto oldest = std::find_if(
        filter.anchors().begin(), filter.anchors().end(),
        [this](std::int64_t id) { return id != axes && !(saved && id == saved->place); });
    if (*oldest >= open().anchor) return;  // all others are views that wait for their features
    for (Stretch& s : stretches) {
      if (s.anchor == *oldest) s.submap = Submap();  // nothing is laid on it any more
    }
    filter.removeAnchor(*oldest);
  }
}

void FusedMapper::Impl::enterSubmap(const SemanticFrame& frame, const View& view) {
  Stretch& s = open();
  s.submap.add(frame, between(s.anchor, view));
  s.rig_turn += (frame.rig_turn - s.rig_turn) / static_cast<double>(s.submap.frames());
}

void FusedMapper::Impl::followCorrections() {
  // The world is the saved map's: what is learned of where that lies moves all the rest.
  if (located()) {
    const GroundPose place = filter.anchor(saved->place);
    rebase(place.T_world_vehicle.inverse(), -place.z);
  }
  std::unordered_map<std::int64_t, SE2> moved;
  constexpr double kNoticeable = 0.002;
  double farthest = 0.0;
  for (Stretch& s : stretches) {
    if (!filter.hasAnchor(s.anchor)) continue;
    s.pose = filter.anchor(s.anchor);
    const SE2 step = s.applied.inverse() * placeOf(s);
    constexpr double kLever = 8.0;
    farthest = std::max(farthest, step.translation().norm() + kLever * std::abs(step.angle()));
  }
  if (farthest < kNoticeable) return;
  for (Stretch& s : stretches) {
    const SE2 place = placeOf(s);
    moved[s.anchor] = place * s.applied.inverse();
    s.applied = place;
    global.setAnchor(s.anchor, s.applied);
  }
  const auto correction = [&](std::int64_t anchor) { return moved.at(anchor); };
  slots.moveWithAnchors(correction);
  objects.moveWithAnchors(correction);
}

void FusedMapper::Impl::enterMaps(const SemanticFrame& frame,
                                  const std::vector<LevelView>& level_views, const View& view) {
  const SE2 pose = poseOf(view);
  const TimeNs t_ns = view.odometry.t_ns;
  // What a car at a standstill sees again and again soon says nothing new for or against what it
  // knows, but for cars and people that come and go.
  constexpr double kStandstill = 0.1;  // m
  constexpr int kLooks = 5;
  if (view.travelled - last_judged >= kStandstill) {
    last_judged = view.travelled;
    looks_here = 0;
  }
  const bool is_new = looks_here++ < kLooks;
  const BevLabels* seen = frame.labels.labels.empty() ? nullptr : &frame.labels;
  if (seen != nullptr) {
    const PackedLabels labels = packLabels(frame);
    local.update(labels, t_ns, SE2::fromSE3(view.odometry.T_odom_vehicle), is_new);
    global.update(labels, t_ns, open().anchor, between(open().anchor, view), is_new);
  }
  wall_points.add(frame.raised, open().anchor, between(open().anchor, view));
  slots.update(frame.slots, t_ns, pose, open().anchor, is_new, seen);
  objects.update(frame.objects, pose, filter.anchor(view.anchor).z, open().anchor, seen,
                 level_views, is_new);
}

std::vector<Eigen::Vector3d> FusedMapper::Impl::wallPlaces() const {
  std::unordered_map<std::int64_t, SE2> anchors;
  for (const Stretch& s : stretches) anchors[s.anchor] = s.applied;
  return wall_points.places([&](std::int64_t anchor) { return anchors.at(anchor); });
}

FusedMapper::FusedMapper(const FusedMapperOptions& options, std::vector<Eigen::Vector3d> viewpoints)
    : impl_(std::make_unique<Impl>(options, std::move(viewpoints))) {}
FusedMapper::~FusedMapper() = default;

Status FusedMapper::locateIn(const ParkingMap& map) {
  impl_->saved.emplace(map);
  return {};
}

PoseEstimate FusedMapper::addOdometry(const PoseEstimate& odometry) {
  Impl& m = *impl_;
  m.predict(odometry);
  m.odometry = odometry;
  m.last_t_ns = odometry.t_ns;
  if (odometry.health != Health::kInitialising) m.history.add(odometry);
  return m.estimate();
}

void FusedMapper::holdView() {
  Impl& m = *impl_;
  PARKADE_CHECK(m.odometry.has_value(), "a view before the first odometry");
  if (m.odometry->health != Health::kInitialising) m.hold();
}

void FusedMapper::dropView() {
  Impl& m = *impl_;
  if (m.views.empty()) return;
  m.filter.removeAnchor(m.views.front().anchor);
  m.views.pop_front();
}

PoseEstimate FusedMapper::estimate() const {
  PARKADE_CHECK(impl_->odometry.has_value(), "no odometry yet");
  return impl_->estimate();
}

PoseEstimate FusedMapper::addSemantics(const SemanticFrame& frame,
                                       const std::vector<LevelView>& views) {
  Impl& m = *impl_;
  PARKADE_CHECK(m.odometry.has_value(), "semantics before the first odometry");
  if (m.views.empty()) {
    if (m.odometry->health == Health::kInitialising) return m.estimate();
    m.hold();
  }
  const Impl::View view = std::move(m.views.front());
  m.views.pop_front();
  m.rig_turn = frame.rig_turn;
  const SubmapOptions& o = m.options.submaps;
  const bool gone = m.saved && std::exchange(m.saved->gone, false);
  const bool begins = m.stretches.empty() || view.travelled - m.open().begin_m >= o.length_m ||
                      view.turned - m.turned_at_stretch >= o.rotation_deg * kDegree || gone;
  if (begins) m.beginStretch(view);
  const bool registers = view.travelled - m.last_registered >= o.register_distance_m;
  if (registers) {
    m.last_registered = view.travelled;
    m.readCompass(frame, view);
    m.registerFrameToSubmaps(frame, view);
  }
  if (view.travelled - m.last_entered >= o.frame_distance_m) {
    m.last_entered = view.travelled;
    m.enterSubmap(frame, view);
  }
  if (m.saved && registers) m.locate(frame, view);
  if (std::exchange(m.corrected, false)) m.followCorrections();
  m.enterMaps(frame, views, view);
  if (!begins) m.filter.removeAnchor(view.anchor);
  return m.estimate();
}

Trajectory FusedMapper::finalTrajectory() const {
  const Impl& m = *impl_;
  return m.history.trajectory([&](std::int64_t anchor) {
    const auto it = std::find_if(m.stretches.begin(), m.stretches.end(),
                                 [&](const Impl::Stretch& s) { return s.anchor == anchor; });
    return it->pose;
  });
}

void FusedMapper::finish() {
  Impl& m = *impl_;
  m.followCorrections();
  m.global.finish();
  m.slots.completeRows(m.last_t_ns, m.objects.objects(), m.global.grid());
}

ParkingMap FusedMapper::map(const std::string& name) const {
  const Impl& m = *impl_;
  ParkingMap map;
  map.name = name;
  map.grid = m.global.grid();
  map.objects = m.objects.objects();
  std::vector<SE2> way;
  for (const StampedPose& pose : finalTrajectory()) way.push_back(SE2::fromSE3(pose.T_world_body));
  map.slots = m.slots.slots(m.last_t_ns, map.objects);
  completeLayers(m.wallPlaces(), way, m.options.global_map.evidence.range_m, map);
  completeArrows(map);
  completeCrossings(map);
  for (const Impl::Stretch& s : m.stretches) {
    map.nodes.push_back(
        {s.anchor, s.t_ns, liftPose(s.pose.T_world_vehicle, s.pose.z, s.T_odom_vehicle)});
  }
  map.edges = m.edges;
  return map;
}

const LocalMap* FusedMapper::localMap() const {
  return &impl_->local;
}
const LayeredGrid& FusedMapper::globalGrid() const {
  return impl_->global.grid();
}
const FusedMapperStatistics& FusedMapper::statistics() const {
  return impl_->statistics;
}

}  // namespace parkade
