// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/agent_tracker.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/core/nearest_first.hpp"

namespace parkade {
namespace {

constexpr double kAgentGate = 9.21;   // 99 % of chi-square, 2 degrees
constexpr double kCarLength = 4.5;    // m
constexpr double kCarWidth = 1.8;     // m
constexpr double kWidestFront = 2.3;  // m: longer faces are sides
constexpr double kLeastFront = 1.1;   // m: shorter ones are pieces

Eigen::Matrix<double, 2, 4> placeOf() {
  Eigen::Matrix<double, 2, 4> H = Eigen::Matrix<double, 2, 4>::Zero();
  H.leftCols<2>().setIdentity();
  return H;
}

}  // namespace

AgentTracker::Measurement AgentTracker::measure(const AgentDetection& detection,
                                                const SE2& T_odom_vehicle) const {
  Measurement m;
  const Eigen::Matrix2d R = T_odom_vehicle.rotationMatrix();
  if (detection.semantic_class == SemanticClass::kPedestrian) {
    m.p_odom = T_odom_vehicle * detection.contact;
    m.covariance = R * detection.covariance * R.transpose();
    m.size = detection.box.size;
    return m;
  }
  // The longer face is a side, or the front or rear of a car that reaches away from it.
  const GroundBox& box = detection.box;
  const int longer = box.size.x() >= box.size.y() ? 0 : 1;
  const double face = box.size[longer];
  const bool side = face > kWidestFront;
  Eigen::Vector2d size;
  size[longer] = side ? std::max(kCarLength, face) : kCarWidth;
  size[1 - longer] = side ? kCarWidth : kCarLength;
  const GroundBox whole = grownTo(box, size, detection.viewer);
  const int along = side ? longer : 1 - longer;
  m.side = side;
  m.whole = face > kLeastFront && !(detection.cut && face < kCarWidth - 0.3);
  m.p_odom = T_odom_vehicle * whole.center;
  m.heading = wrapAngle(whole.heading + (along == 0 ? 0.0 : M_PI_2) + T_odom_vehicle.angle());
  m.size = {whole.size[along], whole.size[1 - along]};
  const double sigma = (m.whole ? 1.0 : 2.5) * options_.vehicle_sigma_m;
  m.covariance =
      R * detection.covariance * R.transpose() + sigma * sigma * Eigen::Matrix2d::Identity();
  return m;
}

void AgentTracker::predict(double dt) {
  Eigen::Matrix4d F = Eigen::Matrix4d::Identity();
  F(0, 2) = F(1, 3) = dt;
  // White acceleration, constant over a step.
  Eigen::Matrix<double, 4, 2> G = Eigen::Matrix<double, 4, 2>::Zero();
  G(0, 0) = G(1, 1) = 0.5 * dt * dt;
  G(2, 0) = G(3, 1) = dt;
  const double q = options_.acceleration * options_.acceleration;
  for (Track& track : tracks_) {
    track.state = F * track.state;
    track.covariance = (F * track.covariance * F.transpose() + q * G * G.transpose()).eval();
  }
}

void AgentTracker::correct(Track& track, const Measurement& m) const {
  const Eigen::Matrix<double, 2, 4> H = placeOf();
  const Eigen::Matrix2d S = H * track.covariance * H.transpose() + m.covariance;
  const Eigen::Matrix<double, 4, 2> K = S.llt().solve(H * track.covariance).transpose();
  track.state += K * (m.p_odom - H * track.state);
  const Eigen::Matrix4d left = Eigen::Matrix4d::Identity() - K * H;
  track.covariance =
      (left * track.covariance * left.transpose() + K * m.covariance * K.transpose()).eval();
  if (m.whole || track.hits == 0) {
    track.size = track.hits == 0 ? m.size : (0.8 * track.size + 0.2 * m.size).eval();
    // A face's direction is known up to half turns, and which face it is may be mistaken.
    double turn = std::remainder(m.heading - track.heading, M_PI);
    const bool other_face = std::abs(turn) > M_PI_4;
    // The first whole side tells what only pieces of it, taken for a front, told until then.
    const bool born_anew = track.hits == 0 || (other_face && m.side && !track.side_seen);
    if (other_face) turn = 0.0;
    track.heading = born_anew ? m.heading : wrapAngle(track.heading + 0.3 * turn);
    track.side_seen = track.side_seen || m.side;
  }
  ++track.hits;
}

void AgentTracker::turnIntoCourse(Track& track) const {
  if (!track.moving || track.semantic_class == SemanticClass::kPedestrian) return;
  if (track.state.tail<2>().norm() < options_.moving_speed) return;  // it comes to rest: noise
  const double course = std::atan2(track.state[3], track.state[2]);
  // Cars go along, not across.
  if (std::abs(std::remainder(track.heading - course, M_PI)) > M_PI_4) track.heading = course;
}

void AgentTracker::judgeMotion(Track& track) const {
  constexpr int kInRow = 3;
  const double speed = track.state.tail<2>().norm();
  const double sigma = std::sqrt(0.5 * track.covariance.bottomRightCorner<2, 2>().trace());
  bool says = false;
  if (track.moving) {
    says = speed < options_.resting_speed;
  } else {
    const double way = (track.state.head<2>() - track.rest).norm();
    says = speed > std::max(options_.moving_speed, 2.5 * sigma) && way > options_.moving_distance_m;
  }
  track.fast = says ? track.fast + 1 : 0;
  if (track.fast < kInRow) return;
  track.moving = !track.moving;
  track.fast = 0;
  track.rest = track.state.head<2>();
}

std::vector<MovingObservation> AgentTracker::update(const std::vector<AgentDetection>& detections,
                                                    const SE2& T_odom_vehicle, TimeNs t_ns) {
  PARKADE_CHECK(tracks_.empty() || t_ns >= last_ns_, "{} ns comes after {} ns", t_ns, last_ns_);
  predict(tracks_.empty() ? 0.0 : toSeconds(t_ns - last_ns_));
  last_ns_ = t_ns;
  std::vector<Measurement> measurements;
  for (const AgentDetection& detection : detections) {
    measurements.push_back(measure(detection, T_odom_vehicle));
  }
  std::vector<TrackPair> pairs;
  for (std::size_t d = 0; d < detections.size(); ++d) {
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      if (tracks_[k].semantic_class != detections[d].semantic_class) continue;
      const Eigen::Matrix2d S =
          tracks_[k].covariance.topLeftCorner<2, 2>() + measurements[d].covariance;
      const Eigen::Vector2d off = measurements[d].p_odom - tracks_[k].state.head<2>();
      const double distance = off.dot(S.llt().solve(off));
      if (distance < kAgentGate) pairs.push_back({distance, k, d});
    }
  }
  auto track_of = matchNearestFirst(std::move(pairs), tracks_.size(), detections.size());
  for (std::size_t d = 0; d < detections.size(); ++d) {
    if (!track_of[d]) continue;
    Track& track = tracks_[*track_of[d]];
    correct(track, measurements[d]);
    track.seen_ns = t_ns;
    judgeMotion(track);
    turnIntoCourse(track);
  }
  for (std::size_t d = 0; d < detections.size(); ++d) {
    if (track_of[d]) continue;
    Track track;
    track.id = next_id_++;
    track.semantic_class = detections[d].semantic_class;
    track.state.head<2>() = measurements[d].p_odom;
    track.covariance.topLeftCorner<2, 2>() = measurements[d].covariance;
    track.covariance.bottomRightCorner<2, 2>() =
        options_.birth_speed * options_.birth_speed * Eigen::Matrix2d::Identity();
    track.size = measurements[d].size;
    track.heading = measurements[d].heading;
    track.side_seen = measurements[d].side;
    track.rest = measurements[d].p_odom;
    track.hits = 1;
    track.seen_ns = t_ns;
    track_of[d] = tracks_.size();
    tracks_.push_back(track);
  }
  std::vector<MovingObservation> out;
  const SE2 T_vehicle_odom = T_odom_vehicle.inverse();
  for (std::size_t d = 0; d < detections.size(); ++d) {
    const Track& track = tracks_[*track_of[d]];
    if (track.hits < options_.confirm_hits) continue;
    MovingObservation o;
    o.id = track.id;
    o.semantic_class = track.semantic_class;
    o.contact = detections[d].contact;
    o.covariance = detections[d].covariance;
    o.velocity = T_vehicle_odom.rotationMatrix() * track.state.tail<2>();
    o.size = track.size;
    double heading = track.heading;
    const Eigen::Vector2d v = track.state.tail<2>();
    if (track.moving) {
      const double course = std::atan2(v.y(), v.x());
      if (track.semantic_class == SemanticClass::kPedestrian) {
        heading = course;
      } else if (std::abs(wrapAngle(heading - course)) > M_PI_2) {
        heading += M_PI;  // the end that leads is the front
      }
    }
    o.heading = wrapAngle(heading - T_odom_vehicle.angle());
    o.moving = track.moving;
    out.push_back(o);
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(),
                               [&](const Track& track) {
                                 return toSeconds(t_ns - track.seen_ns) > options_.forget_s;
                               }),
                tracks_.end());
  return out;
}

}  // namespace parkade
