// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/estimator_impl.hpp"

namespace parkade {
void VioEstimator::Impl::rememberTracks(const Observations& observations, TimeNs t_ns) {
  recent_tracks_.push_back({t_ns, observations});
  const TimeNs span = fromSeconds(options_.standstill.window_s);
  while (recent_tracks_.size() > 1 && recent_tracks_[1].t_ns + span <= t_ns) {
    recent_tracks_.pop_front();
  }
}

std::optional<bool> VioEstimator::Impl::imagesStill(const Observations& observations) const {
  if (recent_tracks_.empty()) return std::nullopt;
  return imagesAtRest(recent_tracks_.front().observations, observations, options_.standstill);
}

void VioEstimator::Impl::detectStandstill(WindowFrame& frame, const Observations& observations) {
  const VioStandstillOptions& options = options_.standstill;
  const bool was_still = still_;
  still_ = false;
  if (options.enable) {
    const std::vector<ImuReading> recent =
        readings_.between(frame.t_ns - fromSeconds(options.window_s), frame.t_ns);
    const StillnessCheck check = checkStillness(recent, noise_, options.noise_tolerance,
                                                options.gyro_floor, options.accel_floor);
    const bool covered = readings_.firstTime() <= frame.t_ns - fromSeconds(options.window_s);
    // Without images even rolling looks like rest: the speed must be known to be small.
    const double speed = originVelocity(frame, window_.T_imu_vehicle).norm();
    const bool slow = speed < options.max_speed;
    still_ = check.quiet && covered && imagesStill(observations).value_or(slow || was_still);
  }
  if (!still_) {
    // What is noticed now may have begun any time since the stretch that was quiet.
    const TimeNs quiet_until = frame.t_ns - fromSeconds(options.window_s);
    for (WindowFrame& recent : window_.frames) {
      if (recent.t_ns > quiet_until && recent.still_since != recent.id) recent.still_since = -1;
    }
    still_anchor_id_ = -1;
    return;
  }
  if (still_anchor_id_ < 0 || window_.indexOf(still_anchor_id_) < 0) {
    still_anchor_id_ = frame.id;
    frame.keyframe = true;
  }
  frame.still_since = still_anchor_id_;
}

}  // namespace parkade
