// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

namespace parkade::sim {

/// A rectangle on the floor that moves: of the own car, or of another agent. pose(t) gives x, y of
/// its middle and its yaw, t in seconds.
struct MovingBox {
  std::function<Eigen::Vector3d(double t)> pose;
  double half_length = 0.0;  ///< m
  double half_width = 0.0;   ///< m
};

/// Distance between two rectangles (x, y, yaw; half length and width), 0 where they overlap.
double boxDistance(const Eigen::Vector3d& a, const Eigen::Vector2d& half_a,
                   const Eigen::Vector3d& b, const Eigen::Vector2d& half_b);

/// The places along an agent's way: x, y of its middle and its yaw, kSpacing apart.
struct AgentTrack {
  static constexpr double kSpacing = 0.125;  ///< m
  std::vector<Eigen::Vector3d> poses;        ///< yaw continuous, not wrapped

  [[nodiscard]] double length() const { return kSpacing * static_cast<double>(poses.size() - 1); }
  /// Between the places, linearly; s is clamped.
  [[nodiscard]] Eigen::Vector3d at(double s) const;
};

/// How an agent may move along its track.
struct AgentLimits {
  int top_speed = 6;         ///< in steps of 0.5 m/s
  int speed_up = 1;          ///< steps of speed per 0.5 s
  int slow_down = 2;         ///< steps of speed per 0.5 s
  double clearance = 0.8;    ///< m, to every box, at every instant
  double start_after = 0.0;  ///< s at rest at the beginning
};

/// Distance along a track over time, with piecewise constant acceleration.
class AgentSchedule {
 public:
  static constexpr double kStep = 0.5;  ///< s
  AgentSchedule(std::vector<double> s, std::vector<double> v)
      : s_(std::move(s)), v_(std::move(v)) {}
  [[nodiscard]] double distance(double t) const;  ///< m; t is clamped
  [[nodiscard]] double speed(double t) const;     ///< m/s

 private:
  std::vector<double> s_;
  std::vector<double> v_;
};

/// The fastest way (each step as fast as can be without running into a dead end later) to move
/// along a track from rest while keeping clear of all boxes, whose motion is known. Nothing where
/// there is none. Searches (time, place, speed), depth first, and remembers dead ends.
std::optional<AgentSchedule> planSchedule(const AgentTrack& track, const Eigen::Vector2d& half_size,
                                          const std::vector<MovingBox>& boxes,
                                          const AgentLimits& limits, double duration);

}  // namespace parkade::sim
