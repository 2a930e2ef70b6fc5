// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "parkade/core/log.hpp"
#include "parkade/core/median.hpp"
#include "parkade/vio/estimator_impl.hpp"

namespace parkade {
namespace {

constexpr double kGaugePosition = 1e-4;  // m: the first pose is where it is by definition
constexpr double kGaugeRotation = 1e-5;  // rad
constexpr std::size_t kMinStartFrames = 5;
constexpr double kFewFramesSpan = 2.5;  // s, at most, of which a start takes so few images
constexpr double kMinRestSpan = 0.25;   // s of quiet readings
constexpr int kStartIterations = 15;
constexpr double kStartBend = 0.3;     // sigma, of Huber's loss
constexpr double kMaxStartCost = 3.0;  // per observation, half squared sigmas
constexpr int kMinStartObservations = 60;
constexpr double kTrialSpeeds[] = {0.4, 1.0, 2.0, 4.0, 8.0};  // m/s
constexpr double kUsualDistance = 4.0;                        // m, of landmarks
constexpr double kDistanceSpread = 2.5;                       // factor, 1 sigma
constexpr double kLeastInverseDistance = 1e-3;                // 1/m; beyond infinity is below 0
constexpr double kMaxSpeedSpread = 0.1;                       // of the speed

}  // namespace

PoseEstimate VioEstimator::Impl::startUp(const TrackSet& tracks) {
  StartUpFrame frame;
  frame.t_ns = tracks.t_ns;
  frame.id = next_id_++;
  frame.observations = FeatureManager::observationsOf(window_.cameras, tracks, frame.id);
  bool started = false;
  if (readings_.empty()) {
    start_reason_ = "no IMU readings yet";
    rememberTracks(frame.observations, frame.t_ns);
  } else {
    const bool images_still = imagesStill(frame.observations, frame.t_ns).value_or(false);
    rememberTracks(frame.observations, frame.t_ns);
    start_frames_.push_back(std::move(frame));
    trimStartFrames();
    started = (images_still && startAtRest()) || startInMotion();
  }
  if (started) {
    initialised_ = true;
    last_vision_ns_ = tracks.t_ns;
    health_ = Health::kTracking;
    reason_.clear();
    start_frames_.clear();
    features_.forgive(window_);
    return estimate();
  }
  PoseEstimate result;
  result.t_ns = tracks.t_ns;
  result.health = Health::kInitialising;
  result.reason = start_reason_;
  return result;
}

// Keeps as many images as a start in motion needs, and little more.
void VioEstimator::Impl::trimStartFrames() {
  const TimeNs now = start_frames_.back().t_ns;
  const double span = std::max(options_.start_up.min_span_s, options_.start_up.max_span_s);
  const TimeNs usual = now - fromSeconds(span + 0.1);
  const TimeNs longest = std::min(usual, now - fromSeconds(kFewFramesSpan));
  while (start_frames_.size() > 1) {
    const TimeNs oldest = start_frames_[0].t_ns;
    const bool spare = oldest < usual && start_frames_.size() > kMinStartFrames &&
                       now - start_frames_[1].t_ns >= fromSeconds(span);
    if (!spare && oldest >= std::max(longest, readings_.firstTime())) break;
    start_frames_.erase(start_frames_.begin());
  }
}

SolveOptions VioEstimator::Impl::startOptions() const {
  SolveOptions solve = solveOptions(kStartIterations);
  // A first guess may be far off: convex, unlike the loss that follows.
  solve.loss.views = {RobustLoss::Kernel::kHuber, kStartBend};
  return solve;
}

bool VioEstimator::Impl::startAtRest() {
  if (!options_.standstill.enable) return false;
  const TimeNs now = start_frames_.back().t_ns;
  const double longest = std::max(options_.standstill.window_s, kMinRestSpan);
  const TimeNs begin = std::max(readings_.firstTime(), now - fromSeconds(longest));
  if (toSeconds(now - begin) < kMinRestSpan) {
    start_reason_ = "too few IMU readings to tell rest from motion";
    return false;
  }
  const std::vector<ImuReading> recent = readings_.between(begin, now);
  const StillnessCheck check =
      checkStillness(recent, noise_, options_.standstill.noise_tolerance,
                     options_.standstill.gyro_floor, options_.standstill.accel_floor);
  if (!check.quiet || std::abs(check.mean_accel.norm() - options_.gravity) > 1.0 ||
      check.mean_gyro.norm() > 4.0 * options_.start_up.bias_gyro_sigma) {
    return false;
  }
  // The accelerometer's bias and the vertical cannot be told apart at rest: the odom frame is made
  // level as it seems, and both are left as uncertain as the bias is.
  ImuBias bias;
  bias.gyro = check.mean_gyro;
  const double span = std::max(toSeconds(now - begin), 0.1);
  StartPrior prior;
  prior.sigma << Eigen::Vector3d::Constant(kGaugePosition),
      Eigen::Vector3d::Constant(kGaugeRotation), Eigen::Vector3d::Constant(5e-3),
      Eigen::Vector3d::Constant(noise_.gyroscope_noise_density / std::sqrt(span) + 1e-4),
      Eigen::Vector3d::Constant(options_.start_up.bias_accel_sigma);
  prior.gravity_sigma = options_.start_up.bias_accel_sigma / options_.gravity;
  std::vector<NavState> states{alignAtRest(check.mean_accel, window_.T_imu_vehicle)};
  continueFromLast(states, prior);
  enterWindow(states, start_frames_.size() - 1, bias, prior);
  still_ = true;
  known_rest_ = KnownRest{now, true, states.front().R_odom_imu,
                          RestReadings{check.mean_gyro, check.mean_accel, 0.0, 0.0}};
  still_anchor_id_ = window_.frames.back().id;
  window_.frames.back().still_since = still_anchor_id_;
  window_.frames.back().keyframe = true;
  optimise(startOptions());
  return true;
}

bool VioEstimator::Impl::startInMotion() {
  const double span = toSeconds(start_frames_.back().t_ns - start_frames_.front().t_ns);
  if (span < options_.start_up.min_span_s || start_frames_.size() < kMinStartFrames) {
    start_reason_ = fmt::format("gathering images in motion: {:.2f} s", span);
    return false;
  }
  const StartUpAlignment alignment =
      alignInMotion(window_.cameras, start_frames_, readings_, noise_, options_.gravity,
                    window_.T_imu_vehicle, options_.start_up.bias_gyro_sigma, gap_ns_);
  if (!alignment.ok) {
    start_reason_ = fmt::format("too few features followed: {}", alignment.num_features);
    return false;
  }
  StartPrior prior;
  prior.sigma << Eigen::Vector3d::Constant(kGaugePosition),
      Eigen::Vector3d::Constant(kGaugeRotation), Eigen::Vector3d::Zero(),
      Eigen::Vector3d::Constant(options_.start_up.bias_gyro_sigma),
      Eigen::Vector3d::Constant(options_.start_up.bias_accel_sigma);
  const bool late = span >= options_.start_up.max_span_s;
  StartTrial best = tryStart(alignment.states, alignment.bias, prior);
  if (!best.sharp()) {
    // Even motion hardly tells its scale from few images, and noise then shrinks the linear
    // solution: other speeds along its direction are tried, and the most plausible is kept.
    std::vector<Eigen::Vector3d> velocities;
    const Eigen::Vector3d along = alignment.states.front().v_odom.normalized();
    if (late) {
      for (const double speed : kTrialSpeeds) velocities.emplace_back(speed * along);
    }
    if (const std::optional<Eigen::Vector3d> wheels = wheelVelocity(alignment.states.front())) {
      velocities.push_back(*wheels);
    }
    for (const Eigen::Vector3d& velocity : velocities) {
      StartTrial trial = tryStart(withVelocity(alignment.states, velocity), alignment.bias, prior);
      if (trial.fits() && (!best.fits() || trial.penalty() < best.penalty())) {
        best = std::move(trial);
      }
    }
  }
  if (best.fits() && (best.sharp() || late)) {
    window_ = std::move(best.window);
    newest_covariance_ = best.summary.newest_covariance;
    global_covariance_ = best.summary.global_covariance;
    statistics.landmarks = best.landmarks;
    statistics.observations = best.summary.observations;
    logInfo("started in motion: {} frames, {} landmarks, speed {:.2f} +- {:.2f} m/s, cost {:.2f}",
            window_.frames.size(), best.landmarks, best.speed, best.speed_sigma, best.cost());
    return true;
  }
  start_reason_ =
      best.fits()
          ? fmt::format("speed uncertain: {:.2f} +- {:.2f} m/s", best.speed, best.speed_sigma)
          : fmt::format("the motion does not explain the images: {:.1f}", best.cost());
  window_.frames.clear();
  window_.features.clear();
  window_.prior = {};
  window_.start.frame_id = -1;
  features_.clear();
  forgetCalibration();
  return false;
}

// Straight ahead: what shrinks the linear solution also turns it.
std::optional<Eigen::Vector3d> VioEstimator::Impl::wheelVelocity(const NavState& first) const {
  WindowFrame frame;
  frame.t_ns = start_frames_.front().t_ns;
  frame.gyro = readings_.at(frame.t_ns).gyro;
  addBodyVelocity(frame);
  if (frame.body_velocity_sigma.x() <= 0.0) return std::nullopt;
  return first.R_odom_imu *
         (window_.T_imu_vehicle.rotation() * Eigen::Vector3d(frame.body_velocity.x(), 0.0, 0.0));
}

// The window that grows from given states of the start's frames.
VioEstimator::Impl::StartTrial VioEstimator::Impl::tryStart(std::vector<NavState> states,
                                                            const ImuBias& bias, StartPrior prior) {
  continueFromLast(states, prior);
  enterWindow(states, 0, bias, prior);
  // The biases' prior is about zero, not about the alignment.
  window_.start.bias = ImuBias{};
  features_.triangulateNew(window_);
  optimise(startOptions());
  features_.forgive(window_);
  features_.triangulateNew(window_);
  const std::vector<WindowFeature*> selected = features_.select(window_);
  StartTrial trial;
  trial.summary = solveWindow(window_, selected, startOptions());
  trial.landmarks = static_cast<int>(selected.size());
  trial.speed = window_.frames.back().state.v_odom.norm();
  trial.speed_sigma = std::sqrt(trial.summary.newest_covariance.block<3, 3>(6, 6).trace());
  std::vector<double> inverses;
  for (const WindowFeature* feature : selected) inverses.push_back(feature->inverse_distance);
  if (!inverses.empty()) {
    trial.median_distance = 1.0 / std::max(median(std::move(inverses)), kLeastInverseDistance);
  }
  trial.window = window_;
  return trial;
}

double VioEstimator::Impl::StartTrial::cost() const {
  return summary.final_cost / std::max(1, summary.observations);
}

bool VioEstimator::Impl::StartTrial::fits() const {
  return summary.ok && summary.has_covariance && summary.observations > kMinStartObservations &&
         cost() < kMaxStartCost;
}

bool VioEstimator::Impl::StartTrial::sharp() const {
  return fits() && speed_sigma < kMaxSpeedSpread * std::max(speed, 0.5);
}

double VioEstimator::Impl::StartTrial::penalty() const {
  // Where the data do not tell the scale: the world around a car is a few metres away. The spread
  // keeps this from outweighing data that do. Per observation, for trials keep different ones.
  const double away = std::log(median_distance / kUsualDistance) / std::log(kDistanceSpread);
  return cost() + 0.5 * away * away / summary.observations;
}

std::vector<NavState> VioEstimator::Impl::withVelocity(const std::vector<NavState>& states,
                                                       const Eigen::Vector3d& first) const {
  std::vector<NavState> result = states;
  const Eigen::Vector3d change = first - states.front().v_odom;
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i].v_odom += change;
    result[i].p_odom += toSeconds(start_frames_[i].t_ns - start_frames_.front().t_ns) * change;
  }
  return result;
}

void VioEstimator::Impl::enterWindow(const std::vector<NavState>& states, std::size_t first,
                                     const ImuBias& bias, const StartPrior& prior) {
  window_.frames.clear();
  window_.features.clear();
  window_.prior = {};
  features_.clear();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const StartUpFrame& start = start_frames_[first + i];
    WindowFrame frame;
    frame.id = start.id;
    frame.t_ns = start.t_ns;
    frame.state = states[i];
    frame.bias = bias;
    frame.gyro = readings_.at(frame.t_ns).gyro;
    frame.cameras = camerasOf(start.observations);
    frame.steady_cameras = frame.cameras;
    if (i > 0) frame.steady_cameras &= window_.frames.back().cameras;
    addBodyVelocity(frame);
    if (i > 0) setImu(frame, start_frames_[first + i - 1].t_ns, bias);
    // Every second frame of the start is a keyframe; the rest leave as recent frames do.
    frame.keyframe = i % 2 == 0 && i + 1 < states.size();
    window_.frames.push_back(frame);
    features_.add(window_, start.observations);
  }
  window_.start = prior;
  window_.start.frame_id = window_.frames.front().id;
  window_.start.state = window_.frames.front().state;
  window_.start.bias = bias;
  forgetCalibration();
  window_.gravity = WindowGravity{};
  window_.gravity.vector = options_.gravity * prior.gravity.normalized();
}

void VioEstimator::Impl::forgetCalibration() {
  for (std::size_t c = 0; c < window_.refinements.size(); ++c) {
    CameraRefinement& refinement = window_.refinements[c];
    window_.cameras[c].T_imu_cam = refinement.prior_T_imu_cam;
    window_.cameras[c].time_offset = refinement.prior_time_offset;
    window_.cameras[c].readout_time = refinement.prior_readout_time;
    refinement.linearised = false;
    refinement.delta.setZero();
  }
}

void VioEstimator::Impl::continueFromLast(std::vector<NavState>& states, StartPrior& prior) const {
  if (!has_last_run_) return;
  // Heading and position go on from where the last window ended; what happened between is unknown.
  // The states are level; odom may not be, so they are tilted as its vertical is known to be.
  const SO3 tilt = SO3::fromTwoVectors(-Eigen::Vector3d::UnitZ(), last_run_gravity_);
  const SE3 last = SE3(last_run_state_.R_odom_imu, last_run_state_.p_odom) * window_.T_imu_vehicle;
  const double heading = (tilt.inverse() * last.rotation()).yaw();
  const SO3 turn = tilt * SO3::fromYawPitchRoll(heading, 0.0, 0.0);
  prior.gravity = last_run_gravity_;
  const double away = std::max(0.0, toSeconds(start_frames_.front().t_ns - last_run_t_ns_));
  const Eigen::Vector3d offset = last.translation() + away * last_run_state_.v_odom;
  for (NavState& state : states) {
    state.R_odom_imu = turn * state.R_odom_imu;
    state.p_odom = turn * state.p_odom + offset;
    state.v_odom = turn * state.v_odom;
  }
  for (int i = 0; i < 3; ++i) {
    prior.sigma(i) = std::sqrt(last_run_covariance_(i, i)) +
                     away * (0.5 + 0.5 * last_run_state_.v_odom.norm()) + kGaugePosition;
  }
  const Eigen::Matrix3d R = last_run_state_.R_odom_imu.matrix();
  const Eigen::Matrix3d rotation = R * last_run_covariance_.block<3, 3>(3, 3) * R.transpose();
  prior.sigma(5) = std::sqrt(rotation(2, 2)) + 0.1 * away + kGaugeRotation;
  // The tilt of the first pose is as uncertain as what the start knows of the vertical.
  prior.sigma.segment<2>(3).setConstant(prior.gravity_sigma);
  prior.gravity_sigma = last_run_gravity_sigma_;
}

void VioEstimator::Impl::restart(const std::string& reason) {
  logWarning("odometry starts again: {}", reason);
  // The frame that diverged is left out.
  if (window_.frames.size() > 1) {
    const WindowFrame& good = window_.frames[window_.frames.size() - 2];
    if (good.state.p_odom.allFinite() && good.state.v_odom.norm() < 60.0) {
      last_run_state_ = good.state;
      last_run_t_ns_ = good.t_ns;
      last_run_covariance_ =
          newest_covariance_.allFinite() ? newest_covariance_ : last_run_covariance_;
      last_run_gravity_ = window_.gravity.vector;
      last_run_gravity_sigma_ =
          std::sqrt(global_covariance_.topLeftCorner<2, 2>().trace()) + kGaugeRotation;
      has_last_run_ = true;
    }
    window_.frames.pop_back();
  }
  history_.freeze(window_);
  for (std::size_t c = 0; c < window_.refinements.size(); ++c) {
    window_.refinements[c].prior_T_imu_cam = window_.cameras[c].T_imu_cam;
    window_.refinements[c].prior_time_offset = window_.cameras[c].time_offset;
    window_.refinements[c].prior_readout_time = window_.cameras[c].readout_time;
  }
  window_.frames.clear();
  window_.features.clear();
  window_.prior = {};
  window_.start.frame_id = -1;
  features_.clear();
  recent_tracks_.clear();
  start_frames_.clear();
  initialised_ = false;
  still_ = false;
  known_rest_.reset();
  still_anchor_id_ = -1;
  start_reason_ = "starting again: " + reason;
  last_.health = Health::kInitialising;
  last_.reason = start_reason_;
  last_.t_ns = last_t_ns;
}

}  // namespace parkade
