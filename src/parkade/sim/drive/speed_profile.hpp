// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/sim/drive/path.hpp"
#include "parkade/sim/drive/uniform_spline.hpp"

namespace parkade::sim {

struct SpeedOptions {
  double max_speed = 4.17;         ///< m/s (15 km/h)
  double max_reverse_speed = 1.2;  ///< m/s
  double max_lateral = 1.3;        ///< m/s^2, in corners
  double max_longitudinal = 0.9;   ///< m/s^2
  /// Width in seconds of the smooth kernel that rounds the speed over time; the jerk stays below
  /// 4.5 * max_longitudinal / jerk_time.
  double jerk_time = 1.8;
  double start_standstill = 1.5;  ///< s before the car moves
  double end_standstill = 1.0;    ///< s after it has stopped
  double gear_standstill = 1.0;   ///< s for a change of direction
};

/// The car stops with its rear axle at s for a while.
struct Stop {
  double s = 0.0;         ///< m, travelled distance
  double duration = 2.0;  ///< s at rest
};

/// Not faster than speed while the rear axle is between the two distances.
struct SpeedLimit {
  double s_begin = 0.0;
  double s_end = 0.0;
  double speed = 0.0;  ///< m/s
};

/// Travelled distance over time: C4, never falling, at rest at both ends.
class SpeedProfile {
 public:
  SpeedProfile() = default;
  /// Drives the path as fast as limits, corners, acceleration and stops allow.
  SpeedProfile(const Path& path, std::vector<Stop> stops, const std::vector<SpeedLimit>& limits,
               const SpeedOptions& options);

  [[nodiscard]] double duration() const { return duration_; }  ///< s
  /// At rest at 0 before the start, and at the end after duration().
  [[nodiscard]] double distance(double t) const;
  [[nodiscard]] double speed(double t) const;         ///< m/s, >= 0
  [[nodiscard]] double acceleration(double t) const;  ///< m/s^2, of the speed

 private:
  UniformSpline<1> distance_;
  double duration_ = 0.0;
};

}  // namespace parkade::sim
