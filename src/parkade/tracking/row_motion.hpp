// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/camera/rig.hpp"
#include "parkade/core/time.hpp"
#include "parkade/geometry/se3.hpp"
#include "parkade/types/motion_prior.hpp"

namespace parkade {

/// How the car goes on while cameras with a rolling shutter read their rows: at the speed and rate
/// of its way since the frame set before. docs/math/tracking.md.
class RowMotion {
 public:
  /// Nothing known, as of a car that stands.
  RowMotion() = default;
  /// t_ns: of the frame set whose rows are read.
  RowMotion(const MotionPrior& prior, TimeNs t_ns);

  /// The vehicle row_time seconds after the stamp, seen from where it was at the stamp.
  [[nodiscard]] SE3 vehicleAt(double row_time) const;

 private:
  Vector6d twist_ = Vector6d::Zero();  ///< vehicle frame, m/s and rad/s
};

/// Two cameras of a rig, a feature's row in the first already read.
class RowPair {
 public:
  /// T_b_a: at one instant.
  RowPair(const RigCamera& a, const RigCamera& b, const SE3& T_b_a, double row_a,
          const RowMotion& motion);

  /// T_b_a where b reads a row, from when a read its own.
  [[nodiscard]] SE3 at(double row_b) const;
  [[nodiscard]] bool rolling() const { return rolling_; }
  /// At one instant.
  [[nodiscard]] const SE3& atOnce() const { return T_b_a_; }

 private:
  const RigCamera& b_;
  SE3 T_b_a_;
  SE3 T_now_a_;  ///< the first camera at its row, seen from the vehicle at the stamp
  const RowMotion& motion_;
  bool rolling_;
};

}  // namespace parkade
