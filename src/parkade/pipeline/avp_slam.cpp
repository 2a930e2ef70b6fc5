// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/avp_slam.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/core/log.hpp"
#include "parkade/core/units.hpp"
#include "parkade/mapping/pose_graph.hpp"
#include "parkade/pipeline/anchored_history.hpp"

namespace parkade {
namespace {

struct LocalPoints {
  std::int64_t id = 0;
  TimeNs t_ns = 0;
  SE2 T_map;     // where it lies, as last optimised
  SE2 odometry;  // where it began
  SE3 odometry_3d;
  double begin_m = 0.0;
  PointCloud cloud;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d high = Eigen::Vector2d::Constant(-1e9);

  explicit LocalPoints(double cell) : cloud(cell) {}
  [[nodiscard]] bool covers(const Eigen::Vector2d& p_map, double margin) const {
    const Eigen::Vector2d p = T_map.inverse() * p_map;
    return (p - low).minCoeff() > -margin && (high - p).minCoeff() > -margin;
  }
};

}  // namespace

class AvpSlam::Impl {
 public:
  struct View {
    PoseEstimate odometry;
    double travelled = 0.0;
    std::size_t at = 0;  // pose of the history
  };

  explicit Impl(const AvpSlamOptions& o) : options(o) {}

  [[nodiscard]] PoseEstimate estimate() const;
  void predict(const PoseEstimate& now);
  void beginLocalMap(const View& view);
  void localise(const PointCloud& seen, const View& view);
  void correct(const SE2& measured, const SE2& at);
  void closeLoops();
  [[nodiscard]] const LocalPoints* mapUnder(const SE2& at) const;
  /// The present estimate of where a view was taken.
  [[nodiscard]] SE2 poseOf(const View& view) const {
    const SE2 T_view_now = SE2::fromSE3(view.odometry.T_odom_vehicle).inverse() *
                           SE2::fromSE3(odometry->T_odom_vehicle);
    return pose * T_view_now.inverse();
  }
  [[nodiscard]] PoseGraphEdge edgeBetween(const LocalPoints& a, const LocalPoints& b,
                                          const SE2& T_a_b, EdgeKind kind, double sigma_m,
                                          double sigma_rad) const;

  AvpSlamOptions options;
  std::optional<PoseEstimate> odometry;  // newest
  std::optional<PoseEstimate> tracked;   // newest with a pose: odometry may start again
  SE2 pose;                              // of the EKF
  Eigen::Matrix3d P = 1e-8 * Eigen::Matrix3d::Identity();  // right perturbation
  std::deque<View> views;
  double travelled = 0.0;
  double last_localised = -1e9;
  std::vector<LocalPoints> maps;  // the last one is open
  std::vector<PoseGraphEdge> edges;
  AnchoredHistory history;
  AvpSlamStatistics statistics;
};

PoseEstimate AvpSlam::Impl::estimate() const {
  PoseEstimate e = *odometry;
  if (e.health == Health::kInitialising) return e;
  const double turn = pose.angle() - odometry->T_odom_vehicle.rotation().yaw();
  e.T_odom_vehicle =
      liftPose(pose, odometry->T_odom_vehicle.translation().z(), odometry->T_odom_vehicle);
  e.velocity_odom = SO3::fromYawPitchRoll(turn, 0.0, 0.0) * odometry->velocity_odom;
  constexpr int kAt[3] = {0, 1, 5};
  for (int i = 0; i < 3; ++i) {
    e.covariance.row(kAt[i]).head<6>().setZero();
    e.covariance.col(kAt[i]).head<6>().setZero();
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) e.covariance(kAt[i], kAt[j]) = P(i, j);
  }
  return e;
}

void AvpSlam::Impl::predict(const PoseEstimate& now) {
  if (now.health == Health::kInitialising) return;
  if (!tracked) {
    pose = SE2::fromSE3(now.T_odom_vehicle);
    tracked = now;
    return;
  }
  const PlanarIncrement step = planarIncrement(*tracked, now, options.odometry);
  tracked = now;
  const Eigen::Matrix3d F = step.T_before_after.inverse().adjoint();
  pose = pose * step.T_before_after;
  P = F * P * F.transpose() + step.covariance.topLeftCorner<3, 3>();
  travelled += step.T_before_after.translation().norm();
}

PoseGraphEdge AvpSlam::Impl::edgeBetween(const LocalPoints& a, const LocalPoints& b,
                                         const SE2& T_a_b, EdgeKind kind, double sigma_m,
                                         double sigma_rad) const {
  PoseGraphEdge edge;
  edge.from = a.id;
  edge.to = b.id;
  edge.kind = kind;
  edge.T_from_to = T_a_b.toSE3();
  const double place = 1.0 / (sigma_m * sigma_m);
  const double turn = 1.0 / (sigma_rad * sigma_rad);
  // The graph is planar: what it does not move is held by odometry.
  const double flat = kind == EdgeKind::kOdometry ? 1e6 : 0.0;
  edge.information.setZero();
  edge.information.diagonal() << place, place, flat, flat, flat, turn;
  return edge;
}

void AvpSlam::Impl::beginLocalMap(const View& view) {
  LocalPoints map(options.cell_m);
  map.id = static_cast<std::int64_t>(maps.size());
  map.t_ns = view.odometry.t_ns;
  map.T_map = poseOf(view);
  map.odometry_3d = view.odometry.T_odom_vehicle;
  map.odometry = SE2::fromSE3(map.odometry_3d);
  map.begin_m = view.travelled;
  if (!maps.empty()) {
    const LocalPoints& before = maps.back();
    const double way = std::max(0.5, view.travelled - before.begin_m);
    edges.push_back(edgeBetween(before, map, before.odometry.inverse() * map.odometry,
                                EdgeKind::kOdometry, options.odometry.translation * std::sqrt(way),
                                options.odometry.yaw_deg * kDegree * std::sqrt(way)));
  }
  maps.push_back(std::move(map));
  history.beginAnchor(maps.back().id, view.at);
  ++statistics.local_maps;
}

const LocalPoints* AvpSlam::Impl::mapUnder(const SE2& at) const {
  // The oldest one: it drifted least.
  for (std::size_t k = 0; k + 1 < maps.size(); ++k) {
    if (maps[k].covers(at.translation(), 0.0)) return &maps[k];
  }
  return nullptr;
}

void AvpSlam::Impl::correct(const SE2& measured, const SE2& at) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
  R.diagonal() << std::pow(options.sigma_m, 2), std::pow(options.sigma_m, 2),
      std::pow(options.sigma_deg * kDegree, 2);
  const Eigen::Vector3d innovation = (at.inverse() * measured).log();
  const Eigen::Matrix3d S = P + R;
  const Eigen::LLT<Eigen::Matrix3d> S_llt(S);
  if (innovation.dot(S_llt.solve(innovation)) > chiSquareQuantile(3, options.gate_probability)) {
    return;
  }
  const Eigen::Matrix3d K = S_llt.solve(P).transpose();
  // The car moved on since; the correction moves along.
  const SE2 since = at.inverse() * pose;
  pose = at * SE2::exp(K * innovation) * since;
  const Eigen::Matrix3d A = Eigen::Matrix3d::Identity() - K;
  P = A * P * A.transpose() + K * R * K.transpose();
  ++statistics.accepted;
}

void AvpSlam::Impl::localise(const PointCloud& seen, const View& view) {
  const SE2 at = poseOf(view);
  const LocalPoints* map = mapUnder(at);
  if (map == nullptr) return;
  ++statistics.registrations;
  const PointIcpResult fit =
      registerPoints(seen, map->cloud, map->T_map.inverse() * at, options.icp);
  if (fit.accepted) correct(map->T_map * fit.T_target_source, at);
}

void AvpSlam::Impl::closeLoops() {
  const LocalPoints& last = maps.back();
  const double sigma = std::sqrt(std::max(P(0, 0), P(1, 1)));
  if (sigma > options.loop_sigma_m) return;
  PointIcpOptions icp = options.icp;
  icp.accept_share = options.loop_share;
  bool closed = false;
  for (std::size_t k = 0; k + 2 < maps.size(); ++k) {
    const LocalPoints& other = maps[k];
    // Do they overlap at all, as far as is known?
    const Eigen::Vector2d middle = last.T_map * Eigen::Vector2d(0.5 * (last.low + last.high));
    if (!other.covers(middle, 0.5 * (last.high - last.low).norm())) continue;
    const PointIcpResult fit =
        registerPoints(last.cloud, other.cloud, other.T_map.inverse() * last.T_map, icp);
    if (!fit.accepted) continue;
    edges.push_back(edgeBetween(other, last, fit.T_target_source, EdgeKind::kLoop, options.sigma_m,
                                options.sigma_deg * kDegree));
    ++statistics.loops;
    closed = true;
  }
  if (!closed) return;
  std::vector<PoseGraphNode> nodes;
  for (const LocalPoints& m : maps) nodes.push_back({m.id, m.t_ns, m.T_map.toSE3()});
  const SE2 before = last.T_map;
  const PoseGraphResult result = optimisePoseGraph(nodes, edges);
  if (!result.usable) {
    logWarning("the pose graph of {} local maps could not be solved", maps.size());
    return;
  }
  for (std::size_t k = 0; k < maps.size(); ++k) {
    maps[k].T_map = SE2::fromSE3(nodes[k].T_world_vehicle);
  }
  pose = maps.back().T_map * before.inverse() * pose;
}

AvpSlam::AvpSlam(const AvpSlamOptions& options) : impl_(std::make_unique<Impl>(options)) {}
AvpSlam::~AvpSlam() = default;

PoseEstimate AvpSlam::addOdometry(const PoseEstimate& odometry) {
  Impl& m = *impl_;
  m.predict(odometry);
  m.odometry = odometry;
  if (odometry.health != Health::kInitialising) m.history.add(odometry);
  return m.estimate();
}

void AvpSlam::holdView() {
  Impl& m = *impl_;
  PARKADE_CHECK(m.odometry.has_value(), "a view before the first odometry");
  if (m.odometry->health == Health::kInitialising) return;
  m.views.push_back({*m.odometry, m.travelled, m.history.size() - 1});
}

void AvpSlam::dropView() {
  Impl& m = *impl_;
  if (m.views.empty()) return;
  m.views.pop_front();
}

PoseEstimate AvpSlam::estimate() const {
  PARKADE_CHECK(impl_->odometry.has_value(), "no odometry yet");
  return impl_->estimate();
}

PoseEstimate AvpSlam::addSemantics(const SemanticFrame& frame,
                                   const std::vector<LevelView>& /*views*/) {
  Impl& m = *impl_;
  PARKADE_CHECK(m.odometry.has_value(), "semantics before the first odometry");
  if (m.views.empty()) holdView();
  if (m.views.empty()) return m.estimate();
  const Impl::View view = std::move(m.views.front());
  m.views.pop_front();
  if (m.maps.empty() || view.travelled - m.maps.back().begin_m >= m.options.local_map_m) {
    if (!m.maps.empty()) m.closeLoops();
    m.beginLocalMap(view);
  }
  const PointCloud seen = pointsOfLabels(frame.labels, m.options.range_m, m.options.cell_m);
  if (view.travelled - m.last_localised >= m.options.localise_distance_m) {
    m.last_localised = view.travelled;
    m.localise(seen, view);
  }
  LocalPoints& open = m.maps.back();
  const SE2 T_local_vehicle = open.odometry.inverse() * SE2::fromSE3(view.odometry.T_odom_vehicle);
  open.cloud.add(seen, T_local_vehicle);
  for (const SemanticPoint& point : seen.points()) {
    const Eigen::Vector2d p = T_local_vehicle * point.p;
    open.low = open.low.cwiseMin(p);
    open.high = open.high.cwiseMax(p);
  }
  return m.estimate();
}

void AvpSlam::finish() {
  if (!impl_->maps.empty()) impl_->closeLoops();
}

ParkingMap AvpSlam::map(const std::string& name) const {
  const Impl& m = *impl_;
  ParkingMap map;
  map.name = name;
  for (const LocalPoints& local : m.maps) {
    for (const SemanticPoint& point : local.cloud.points()) {
      const Eigen::Vector2d p = local.T_map * point.p;
      constexpr float kSure = 1.0F;
      switch (point.kind) {
        case PointKind::kLine:
          map.grid.add(GridLayer::kParkingLines, p, SemanticClass::kSlotLine, kSure);
          break;
        case PointKind::kGuideSign:
          map.grid.add(GridLayer::kRoadMarkers, p, SemanticClass::kArrow, kSure);
          break;
        case PointKind::kBump:
          map.grid.add(GridLayer::kRoadMarkers, p, SemanticClass::kSpeedBump, kSure);
          break;
      }
    }
    map.nodes.push_back({local.id, local.t_ns, liftPose(local.T_map, 0.0, local.odometry_3d)});
  }
  map.edges = m.edges;
  return map;
}

Trajectory AvpSlam::finalTrajectory() const {
  const Impl& m = *impl_;
  return m.history.trajectory([&](std::int64_t id) {
    const LocalPoints& map = m.maps[static_cast<std::size_t>(id)];
    return GroundPose{map.T_map, map.odometry_3d.translation().z()};
  });
}

const AvpSlamStatistics& AvpSlam::statistics() const {
  return impl_->statistics;
}

}  // namespace parkade
