// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/fused_mapper.hpp"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "parkade/core/check.hpp"
#include "parkade/core/log.hpp"
#include "parkade/fusion/pose_filter.hpp"
#include "parkade/mapping/submap.hpp"

namespace parkade {
namespace {

constexpr double kDegree = M_PI / 180.0;

// A stretch of the drive: an anchor of the filter, and what was seen from there on.
struct Stretch {
  std::int64_t anchor = 0;
  TimeNs t_ns = 0;
  double begin_m = 0.0;  // way travelled
  double end_m = 0.0;
  bool closed = false;
  Submap submap;
  GroundPose pose;  // as last known
  SE2 applied;      // that the map was made with
  SE3 T_odom_vehicle;
};

// Adds a covariance that all measurements with this one share: only in its observable directions.
Eigen::Matrix3d withSharedNoise(const Eigen::Matrix3d& information, const Eigen::Matrix3d& shared) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  constexpr double kLeast = 1e-6;
  for (int k = 0; k < 3; ++k) {
    if (eigen.eigenvalues()[k] <= kLeast) continue;
    const Eigen::Vector3d u = eigen.eigenvectors().col(k);
    result += u * u.transpose() / (1.0 / eigen.eigenvalues()[k] + u.dot(shared * u));
  }
  return result;
}

double largestSigma(const Eigen::Matrix2d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()[1]));
}

}  // namespace

class FusedMapper::Impl {
 public:
  Impl(const FusedMapperOptions& o, std::vector<Eigen::Vector3d> cameras)
      : options(o),
        viewpoints(std::move(cameras)),
        compass(o.compass),
        local(o.local_map),
        global(o.global_map),
        slots(o.slots),
        objects(o.objects) {}

  PoseEstimate estimate() const;
  void predict(const PoseEstimate& odometry);
  void beginStretch();
  void enterMaps(const SemanticFrame& frame);
  void readCompass(const SemanticFrame& frame);
  void registerFrameToSubmaps(const SemanticFrame& frame);
  void tryStretch(const SemanticFrame& frame, std::size_t index, bool revisit);
  void addLoopEdge(const Stretch& stretch, const Registration& fit);
  void followCorrections();
  Stretch& open() { return stretches.back(); }

  FusedMapperOptions options;
  std::vector<Eigen::Vector3d> viewpoints;
  Compass compass;
  PoseFilter filter;
  std::optional<PoseEstimate> odometry;
  double travelled = 0.0;
  double turned = 0.0;  // since the open stretch began
  std::vector<Stretch> stretches;
  std::vector<PoseGraphEdge> edges;
  double last_entered = -1e9;
  double last_registered = -1e9;
  bool corrected = false;
  std::string fit_reason;
  LocalMap local;
  GlobalMap global;
  SlotRegistry slots;
  ObjectRegistry objects;
  TimeNs last_t_ns = 0;
  FusedMapperStatistics statistics;
};

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
  const Eigen::Matrix4d P = filter.covariance();
  constexpr int kAt[4] = {0, 1, 5, 2};  // x, y, angle, z
  for (const int i : kAt) {
    level.row(i).setZero();
    level.col(i).setZero();
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) level(kAt[i], kAt[j]) = P(i, j);
  }
  e.covariance.topLeftCorner<6, 6>() = to_level.transpose() * level * to_level;
  return e;
}

void FusedMapper::Impl::predict(const PoseEstimate& now) {
  if (!odometry || odometry->health == Health::kInitialising) {
    if (now.health == Health::kInitialising) return;
    constexpr double kStart = 1e-8;  // the world frame is where the first pose says
    filter = PoseFilter({SE2::fromSE3(now.T_odom_vehicle), now.T_odom_vehicle.translation().z()},
                        kStart * Eigen::Matrix4d::Identity());
    return;
  }
  if (now.health == Health::kInitialising) return;
  const PlanarIncrement step = planarIncrement(*odometry, now, options.odometry);
  filter.predict(step.T_before_after, step.dz, step.covariance);
  travelled += step.T_before_after.translation().norm();
  turned += std::abs(step.T_before_after.angle());
}

void FusedMapper::Impl::beginStretch() {
  if (!stretches.empty()) {
    open().closed = true;
    open().end_m = travelled;
  }
  Stretch stretch;
  stretch.anchor = filter.addAnchor();
  stretch.t_ns = odometry->t_ns;
  stretch.begin_m = travelled;
  stretch.pose = filter.pose();
  stretch.applied = stretch.pose.T_world_vehicle;
  stretch.T_odom_vehicle = odometry->T_odom_vehicle;
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
  turned = 0.0;
  ++statistics.anchors;
  if (static_cast<int>(filter.anchors().size()) > options.submaps.max_anchors) {
    filter.removeAnchor(filter.anchors().front());
  }
}

void FusedMapper::Impl::addLoopEdge(const Stretch& stretch, const Registration& fit) {
  if (!edges.empty() && edges.back().kind == EdgeKind::kLoop &&
      edges.back().from == stretch.anchor && edges.back().to == open().anchor) {
    return;  // one per pair of stretches
  }
  PoseGraphEdge edge;
  edge.from = stretch.anchor;
  edge.to = open().anchor;
  edge.kind = EdgeKind::kLoop;
  const SE2 T_open_vehicle =
      filter.anchor(open().anchor).T_world_vehicle.inverse() * filter.pose().T_world_vehicle;
  edge.T_from_to = (fit.T_map_vehicle * T_open_vehicle.inverse()).toSE3();
  edge.information.setZero();
  constexpr int kAt[3] = {0, 1, 5};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) edge.information(kAt[i], kAt[j]) = fit.information(i, j);
  }
  edges.push_back(edge);
}

void FusedMapper::Impl::tryStretch(const SemanticFrame& frame, std::size_t index, bool revisit) {
  const Stretch& stretch = stretches[index];
  const SE2 expected =
      filter.anchor(stretch.anchor).T_world_vehicle.inverse() * filter.pose().T_world_vehicle;
  const Eigen::Matrix4d P = filter.relativeCovariance(stretch.anchor);
  const double sigma = largestSigma(P.topLeftCorner<2, 2>());
  ++(revisit ? statistics.revisits : statistics.registrations);
  Registration fit;
  // Half of the narrowest slot is the distance at which rows look alike.
  constexpr double kCertain = 0.25;
  if (sigma < kCertain) {
    fit = registerFrame(frame, stretch.submap, expected, options.registration, viewpoints);
  } else if (revisit) {
    const LoopResult loop =
        searchInSubmap(frame, stretch.submap, expected, sigma, std::sqrt(P(2, 2)), options.loop,
                       options.registration, viewpoints);
    fit = loop.registration;
    fit.accepted = loop.accepted;
    fit.reason = loop.reason;
  } else {
    fit.reason = "the pose is too uncertain";
  }
  if (!fit.accepted) {
    logDebug("registration to stretch {}: {}", stretch.anchor, fit.reason);
    return;
  }
  // All registrations to a submap share its error: each is as unsure as if it were the only one
  // of those that follow at this spacing.
  const double uses = std::max(
      1.0, (options.submaps.length_m + 5.0) / std::max(0.1, options.submaps.register_distance_m));
  Eigen::Matrix3d shared = Eigen::Matrix3d::Zero();
  shared.diagonal() << std::pow(options.submaps.sigma_m, 2), std::pow(options.submaps.sigma_m, 2),
      std::pow(options.submaps.sigma_deg * kDegree, 2);
  const Eigen::Matrix3d information = withSharedNoise(fit.information, uses * shared);
  const FilterUpdate update = filter.updateRelative(stretch.anchor, fit.T_map_vehicle, information,
                                                    options.submaps.gate_probability);
  if (!update.accepted) {
    ++statistics.refused_by_gate;
    return;
  }
  corrected = true;
  ++(revisit ? statistics.loops : statistics.accepted);
  if (!revisit) return;
  // Over the same ground the car stands as high as it did; only where it was near the anchor.
  constexpr double kSamePlace = 3.0;
  const double distance = fit.T_map_vehicle.translation().norm();
  if (distance < kSamePlace) {
    filter.updateHeight(stretch.anchor, 0.0, options.submaps.height_sigma_m + 0.01 * distance,
                        0.999);
  }
  addLoopEdge(stretch, fit);
}

void FusedMapper::Impl::readCompass(const SemanticFrame& frame) {
  const double expected = filter.pose().T_world_vehicle.angle();
  const std::optional<double> heading = compass.read(frame, expected, travelled);
  if (!heading) return;
  const FilterUpdate update = filter.updateHeading(*heading, options.compass.sigma_deg * kDegree,
                                                   options.submaps.gate_probability);
  if (!update.accepted) return;
  ++statistics.headings;
  corrected = true;
}

void FusedMapper::Impl::registerFrameToSubmaps(const SemanticFrame& frame) {
  // The oldest stretch of this passage that still overlaps, and the nearest of an earlier one.
  std::optional<std::size_t> recent;
  std::optional<std::size_t> earlier;
  double nearest = 1e9;
  const Eigen::Vector2d& at = frame.labels.geometry.center;
  for (std::size_t i = 0; i + 1 < stretches.size(); ++i) {
    const Stretch& s = stretches[i];
    if (!filter.hasAnchor(s.anchor) || s.submap.frames() == 0) continue;
    const double age = travelled - s.end_m;
    if (age < options.submaps.min_age_m) continue;
    const SE2 T = filter.anchor(s.anchor).T_world_vehicle.inverse() * filter.pose().T_world_vehicle;
    const Eigen::Vector2d p = T * at;
    constexpr double kMargin = 3.0;
    if ((p - s.submap.low()).minCoeff() < -kMargin || (s.submap.high() - p).minCoeff() < -kMargin) {
      continue;
    }
    // Floors above and below: a revisit is at the same height.
    constexpr double kSameFloor = 1.5;
    if (std::abs(filter.anchor(s.anchor).z - filter.pose().z) > kSameFloor) continue;
    if (age < options.submaps.revisit_age_m) {
      if (!recent) recent = i;
      continue;
    }
    const Eigen::Vector2d middle = 0.5 * (s.submap.low() + s.submap.high());
    const double distance = (p - middle).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    earlier = i;
  }
  if (recent) tryStretch(frame, *recent, false);
  if (earlier) tryStretch(frame, *earlier, true);
}

void FusedMapper::Impl::followCorrections() {
  std::unordered_map<std::int64_t, SE2> moved;
  constexpr double kNoticeable = 0.002;
  double farthest = 0.0;
  for (Stretch& s : stretches) {
    if (!filter.hasAnchor(s.anchor)) continue;
    s.pose = filter.anchor(s.anchor);
    const SE2 step = s.applied.inverse() * s.pose.T_world_vehicle;
    constexpr double kLever = 8.0;
    farthest = std::max(farthest, step.translation().norm() + kLever * std::abs(step.angle()));
  }
  if (farthest < kNoticeable) return;
  for (Stretch& s : stretches) {
    moved[s.anchor] = s.pose.T_world_vehicle * s.applied.inverse();
    s.applied = s.pose.T_world_vehicle;
    global.setAnchor(s.anchor, s.applied);
  }
  const auto correction = [&](std::int64_t anchor) { return moved.at(anchor); };
  slots.moveWithAnchors(correction);
  objects.moveWithAnchors(correction);
}

void FusedMapper::Impl::enterMaps(const SemanticFrame& frame) {
  const SE2& pose = filter.pose().T_world_vehicle;
  if (!frame.labels.labels.empty()) {
    const PackedLabels labels = packLabels(frame);
    local.update(labels, odometry->t_ns, SE2::fromSE3(odometry->T_odom_vehicle));
    const SE2 T_anchor_vehicle = filter.anchor(open().anchor).T_world_vehicle.inverse() * pose;
    global.update(labels, odometry->t_ns, open().anchor, T_anchor_vehicle);
  }
  slots.update(frame.slots, odometry->t_ns, pose, open().anchor);
  objects.update(frame.objects, pose, filter.pose().z, open().anchor);
}

FusedMapper::FusedMapper(const FusedMapperOptions& options, std::vector<Eigen::Vector3d> viewpoints)
    : impl_(std::make_unique<Impl>(options, std::move(viewpoints))) {}
FusedMapper::~FusedMapper() = default;

PoseEstimate FusedMapper::addOdometry(const PoseEstimate& odometry) {
  Impl& m = *impl_;
  m.predict(odometry);
  m.odometry = odometry;
  m.last_t_ns = odometry.t_ns;
  return m.estimate();
}

PoseEstimate FusedMapper::addSemantics(const SemanticFrame& frame) {
  Impl& m = *impl_;
  PARKADE_CHECK(m.odometry.has_value(), "semantics before the first odometry");
  if (m.odometry->health == Health::kInitialising) return m.estimate();
  const SubmapOptions& o = m.options.submaps;
  if (m.stretches.empty() || m.travelled - m.open().begin_m >= o.length_m ||
      m.turned >= o.rotation_deg * kDegree) {
    m.beginStretch();
  }
  if (m.travelled - m.last_registered >= o.register_distance_m) {
    m.last_registered = m.travelled;
    m.readCompass(frame);
    m.registerFrameToSubmaps(frame);
  }
  if (m.travelled - m.last_entered >= o.frame_distance_m) {
    m.last_entered = m.travelled;
    const SE2 T_anchor_vehicle = m.filter.anchor(m.open().anchor).T_world_vehicle.inverse() *
                                 m.filter.pose().T_world_vehicle;
    m.open().submap.add(frame, T_anchor_vehicle);
  }
  if (std::exchange(m.corrected, false)) m.followCorrections();
  m.enterMaps(frame);
  return m.estimate();
}

void FusedMapper::finish() {
  impl_->followCorrections();
  impl_->global.finish();
}

ParkingMap FusedMapper::map(const std::string& name) const {
  const Impl& m = *impl_;
  ParkingMap map;
  map.name = name;
  map.grid = m.global.grid();
  map.objects = m.objects.objects();
  map.slots = m.slots.slots(m.last_t_ns, map.objects);
  for (const Stretch& s : m.stretches) {
    map.nodes.push_back(
        {s.anchor, s.t_ns, liftPose(s.pose.T_world_vehicle, s.pose.z, s.T_odom_vehicle)});
  }
  map.edges = m.edges;
  return map;
}

const LocalMap& FusedMapper::localMap() const {
  return impl_->local;
}
const LayeredGrid& FusedMapper::globalGrid() const {
  return impl_->global.grid();
}
const FusedMapperStatistics& FusedMapper::statistics() const {
  return impl_->statistics;
}

}  // namespace parkade
