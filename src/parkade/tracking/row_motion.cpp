// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/row_motion.hpp"

namespace parkade {

RowMotion::RowMotion(const MotionPrior& prior, TimeNs t_ns) {
  const double dt = toSeconds(t_ns - prior.previous_t_ns);
  if (!prior.valid || !prior.translation_valid || dt <= 0.0) return;
  twist_ = prior.T_previous_current.log() / dt;
}

SE3 RowMotion::vehicleAt(double row_time) const {
  return SE3::exp(row_time * twist_);
}

RowPair::RowPair(const RigCamera& a, const RigCamera& b, const SE3& T_b_a, double row_a,
                 const RowMotion& motion)
    : b_(b),
      T_b_a_(T_b_a),
      motion_(motion),
      rolling_(a.readout_time > 0.0 || b.readout_time > 0.0) {
  if (rolling_) T_now_a_ = motion.vehicleAt(a.rowTime(row_a)) * a.T_vehicle_cam;
}

SE3 RowPair::at(double row_b) const {
  if (!rolling_) return T_b_a_;
  return (motion_.vehicleAt(b_.rowTime(row_b)) * b_.T_vehicle_cam).inverse() * T_now_a_;
}

}  // namespace parkade
