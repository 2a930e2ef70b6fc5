// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "parkade/vio/estimator_impl.hpp"

namespace parkade {
namespace {

constexpr double kLongEnough = 0.7;  // of window_s, between frame sets that images are compared in
constexpr double kTurningWheels = 2.0;  // sigmas of the wheels' speed
constexpr double kSurelyTurning = 5.0;  // the same, against pictures that stand still

}  // namespace

void VioEstimator::Impl::rememberTracks(const Observations& observations, TimeNs t_ns) {
  recent_tracks_.push_back({t_ns, observations});
  const TimeNs span = fromSeconds(options_.standstill.window_s);
  while (recent_tracks_.size() > 1 && recent_tracks_[1].t_ns + span <= t_ns) {
    recent_tracks_.pop_front();
  }
}

std::optional<bool> VioEstimator::Impl::imagesStill(const Observations& observations,
                                                    TimeNs t_ns) const {
  if (recent_tracks_.empty()) return std::nullopt;
  // Cameras may take turns.
  const std::uint64_t cameras = camerasOf(observations);
  const TimeNs latest = t_ns - fromSeconds(kLongEnough * options_.standstill.window_s);
  const RecentTracks* before = &recent_tracks_.front();
  for (const RecentTracks& tracks : recent_tracks_) {
    if (&tracks != before && tracks.t_ns > latest) break;
    if ((camerasOf(tracks.observations) & cameras) == 0) continue;
    before = &tracks;
    break;
  }
  return imagesAtRest(before->observations, observations, options_.standstill);
}

bool VioEstimator::Impl::wheelsTurn(const WindowFrame& frame, double sigmas) const {
  const double sigma = frame.body_velocity_sigma.x();
  return sigma > 0.0 && std::abs(frame.body_velocity.x()) > sigmas * sigma;
}

bool VioEstimator::Impl::readingsAreOfRest(const WindowFrame& frame, const StillnessCheck& check,
                                           bool was_still) const {
  const VioStandstillOptions& options = options_.standstill;
  // A car that was held stood as it was held; hours without readings say nothing else.
  const NavState& state = was_still ? window_.frames.back().state : frame.state;
  const SO3 R_imu_odom = state.R_odom_imu.inverse();
  RestReadings rest;
  double age = 0.0;
  if (known_rest_) {
    rest = known_rest_->readings;
    // The car may have been rocked since, as by somebody who gets in.
    rest.accel = R_imu_odom * (known_rest_->R_odom_imu * rest.accel);
    age = toSeconds(frame.t_ns - known_rest_->t_ns);
  } else {
    // A car that comes to rest unseen: what the state expects there.
    rest.gyro = frame.bias.gyro;
    rest.accel = frame.bias.accel - R_imu_odom * window_.gravity.vector;
    rest.gyro_doubt = options.gyro_floor;
    rest.accel_doubt = options.accel_floor;
  }
  return meansAreOfRest(check, rest, noise_, options.window_s, age);
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
    const std::optional<bool> seen = imagesStill(observations, frame.t_ns);
    // Without images even rolling looks like rest: the speed must be known to be small, and the
    // readings must be those of rest.
    const double speed = originVelocity(frame, window_.T_imu_vehicle).norm();
    const bool slow = speed < options.max_speed || was_still;
    if (!slow) known_rest_.reset();
    // Pictures that a camera gives again and again stand still, too.
    const bool vouched = seen ? *seen && !wheelsTurn(frame, kSurelyTurning)
                              : slow && !wheelsTurn(frame, kTurningWheels) &&
                                    readingsAreOfRest(frame, check, was_still);
    still_ = check.quiet && covered && vouched;
    rememberRest(frame, check, seen.has_value());
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

// Readings of a rest that images vouched for stay known in the dark, while the car is slow: it may
// have been rocked, or be about to leave.
void VioEstimator::Impl::rememberRest(const WindowFrame& frame, const StillnessCheck& check,
                                      bool seen) {
  if (still_ && (seen || !known_rest_)) {
    known_rest_ = KnownRest{frame.t_ns, seen, frame.state.R_odom_imu,
                            RestReadings{check.mean_gyro, check.mean_accel, 0.0, 0.0}};
  } else if (!still_ && known_rest_ && (seen || !known_rest_->seen)) {
    known_rest_.reset();
  }
}

}  // namespace parkade
