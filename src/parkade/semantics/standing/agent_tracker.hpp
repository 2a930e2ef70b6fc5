// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/core/time.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/semantics/standing/object_agents.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct AgentTrackerOptions {
  double acceleration = 1.0;
  double vehicle_sigma_m = 0.35;
  double birth_speed = 1.5;
  double forget_s = 1.0;
  int confirm_hits = 2;
  double moving_speed = 0.5;
  double resting_speed = 0.25;
  double moving_distance_m = 0.6;

  void visit(OptionVisitor& v) {
    v.field("acceleration", acceleration, "m/s^2", "How agents change their speed, 1 sigma.", 0.01,
            20.0);
    v.field("vehicle_sigma_m", vehicle_sigma_m, "m",
            "Error of a vehicle's middle where only one or two faces are seen.", 0.01, 5.0);
    v.field("birth_speed", birth_speed, "m/s", "Speed of what is seen first, 1 sigma.", 0.01, 20.0);
    v.field("forget_s", forget_s, "s", "Agents not seen for longer are forgotten.", 0.05, 60.0);
    v.field("confirm_hits", confirm_hits, "count", "Agents are told when seen this often.", 1, 100);
    v.field("moving_speed", moving_speed, "m/s", "Agents faster than this move.", 0.05, 10.0);
    v.field("resting_speed", resting_speed, "m/s", "Moving agents slower than this come to rest.",
            0.0, 10.0);
    v.field("moving_distance_m", moving_distance_m, "m",
            "And only those that came this far since they were seen first, or rested.", 0.0, 10.0);
  }
};

/// Follows vehicles and people over pictures: a Kalman filter of constant velocity for each, in the
/// odometry's frame; detections go to the nearest track of their class within a gate (99 %),
/// nearest pairs first. docs/math/agents.md.
class AgentTracker {
 public:
  explicit AgentTracker(const AgentTrackerOptions& options) : options_(options) {}

  /// Takes the detections of one picture and where the (levelled) vehicle was; in order of time
  /// (checked). Gives the agents seen in it that were seen often enough, by id, in the vehicle's
  /// frame.
  std::vector<MovingObservation> update(const std::vector<AgentDetection>& detections,
                                        const SE2& T_odom_vehicle, TimeNs t_ns);

  void reset() { tracks_.clear(); }

 private:
  struct Measurement {
    Eigen::Vector2d p_odom = Eigen::Vector2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
    Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< length, width
    double heading = 0.0;                            ///< in odom; a vehicle's up to pi
    bool whole = true;                               ///< enough was seen to tell the middle
    bool side = false;                               ///< a face longer than any front
  };
  struct Track {
    std::uint64_t id = 0;
    SemanticClass semantic_class = SemanticClass::kVehicle;
    Eigen::Vector4d state = Eigen::Vector4d::Zero();  ///< place, velocity, in odom
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
    Eigen::Vector2d size = Eigen::Vector2d::Zero();
    double heading = 0.0;
    Eigen::Vector2d rest = Eigen::Vector2d::Zero();  ///< where it was first, or came to rest
    int hits = 0;
    int fast = 0;  ///< updates in a row that say that it moves (or, while it moves: rests)
    bool moving = false;
    bool side_seen = false;  ///< the heading rests on a side
    TimeNs seen_ns = 0;
  };
  [[nodiscard]] Measurement measure(const AgentDetection& detection,
                                    const SE2& T_odom_vehicle) const;
  void predict(double dt);
  void correct(Track& track, const Measurement& measurement) const;
  void judgeMotion(Track& track) const;
  void turnIntoCourse(Track& track) const;

  AgentTrackerOptions options_;
  std::vector<Track> tracks_;
  std::uint64_t next_id_ = 1;
  TimeNs last_ns_ = 0;
};

}  // namespace parkade
