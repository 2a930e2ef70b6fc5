// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/predictor.hpp"

#include "parkade/core/check.hpp"
#include "parkade/imu/preintegration.hpp"

namespace parkade {
namespace {

constexpr TimeNs kMaxAhead = 5 * kNsPerSecond;

NavState propagated(const ReadingBuffer& readings, const NavState& state, const ImuBias& bias,
                    const Eigen::Vector3d& gravity, TimeNs begin_ns, TimeNs end_ns) {
  Preintegration sum(ImuNoise{}, bias);
  sum.integrate(readings.between(begin_ns, end_ns), kMaxAhead);
  return sum.propagate(state, bias, gravity);
}

}  // namespace

void MotionPredictor::addImu(const ImuSample& sample) {
  (void)readings_.add({sample.t_ns, sample.gyro, sample.accel});
}

MotionPrior MotionPredictor::predict(TimeNs previous_t_ns, TimeNs t_ns) const {
  PARKADE_CHECK(previous_t_ns <= t_ns, "prediction from {} back to {}", previous_t_ns, t_ns);
  MotionPrior prior;
  prior.previous_t_ns = previous_t_ns;
  if (!valid_ || readings_.empty() || previous_t_ns < t_ns_ || t_ns - t_ns_ > kMaxAhead) {
    return prior;
  }
  const NavState previous = propagated(readings_, state_, bias_, gravity_, t_ns_, previous_t_ns);
  const NavState current = propagated(readings_, previous, bias_, gravity_, previous_t_ns, t_ns);
  const SE3 T_odom_previous = SE3(previous.R_odom_imu, previous.p_odom) * T_vehicle_imu_.inverse();
  const SE3 T_odom_current = SE3(current.R_odom_imu, current.p_odom) * T_vehicle_imu_.inverse();
  prior.valid = true;
  prior.T_previous_current = T_odom_previous.inverse() * T_odom_current;
  if (rotation_only_) {
    // The velocity is not known yet: the rotation alone, about the vehicle's origin.
    prior.T_previous_current.translation().setZero();
    return prior;
  }
  prior.translation_valid = true;
  prior.readout_times = readout_times_;
  const SE3 T_previous_odom = T_odom_previous.inverse();
  prior.p_previous.reserve(points_odom_.size());
  for (const auto& [id, p_odom] : points_odom_)
    prior.p_previous.emplace(id, T_previous_odom * p_odom);
  return prior;
}

}  // namespace parkade
