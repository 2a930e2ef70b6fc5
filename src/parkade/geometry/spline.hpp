// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/core/time.hpp"
#include "parkade/geometry/se3.hpp"

namespace parkade {

/// A motion that is C2 in position and attitude: uniform cubic B-splines, cumulative on SO3
/// (Sommer et al., "Efficient derivative computation for cumulative B-splines on Lie groups",
/// CVPR 2020; the split form R3 x SO3). Derivations: docs/math/spline.md.
class SplineSE3 {
 public:
  /// The spline of given control poses, dt_ns apart; at least four. It covers
  /// [start_ns, start_ns + (control.size() - 3) * dt_ns]: pose i + 1 has its weight around
  /// start_ns + i * dt_ns.
  SplineSE3(TimeNs start_ns, TimeNs dt_ns, std::vector<SE3> control);

  /// The spline that passes through poses dt_ns apart, the first at start_ns (at least two;
  /// neighbours less than 90 deg apart). It covers all of them; its second derivative is zero at
  /// both ends.
  static SplineSE3 through(TimeNs start_ns, TimeNs dt_ns, const std::vector<SE3>& poses);

  struct Sample {
    SE3 T_world_body;
    Eigen::Vector3d velocity_world;             ///< m/s
    Eigen::Vector3d acceleration_world;         ///< m/s^2
    Eigen::Vector3d angular_velocity_body;      ///< rad/s
    Eigen::Vector3d angular_acceleration_body;  ///< rad/s^2
  };
  /// Pose and derivatives; t_ns must lie in [startNs(), endNs()] (checked).
  [[nodiscard]] Sample at(TimeNs t_ns) const;
  /// The same at a real-valued time, seconds after startNs().
  [[nodiscard]] Sample atSeconds(double seconds_since_start) const;

  [[nodiscard]] TimeNs startNs() const { return start_ns_; }
  [[nodiscard]] TimeNs endNs() const;

 private:
  [[nodiscard]] Sample evaluate(std::size_t segment, double u) const;

  TimeNs start_ns_;
  TimeNs dt_ns_;
  std::vector<SE3> control_;
};

}  // namespace parkade
