// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "parkade/core/log.hpp"
#include "parkade/vio/calibration_spread.hpp"
#include "parkade/vio/estimator_impl.hpp"

namespace parkade {
namespace {

constexpr double kSaneSpeed = 60.0;       // m/s
constexpr double kSaneBiasGyro = 0.5;     // rad/s
constexpr double kSaneBiasAccel = 5.0;    // m/s^2
constexpr int kMinTrackedLandmarks = 10;  // fewer: degraded
constexpr double kKeepReadings = 2.0;     // s
// Of a reading: sums that begin or end so near to it may have been interpolated from it.
constexpr TimeNs kReach = 50 * kNsPerMs;

ImuNoise toldNoise(const ImuCalibration& imu) {
  ImuNoise noise;
  noise.gyroscope_noise_density = imu.gyroscope_noise_density;
  noise.gyroscope_random_walk = imu.gyroscope_random_walk;
  noise.accelerometer_noise_density = imu.accelerometer_noise_density;
  noise.accelerometer_random_walk = imu.accelerometer_random_walk;
  return noise;
}

}  // namespace

Eigen::Vector3d originVelocity(const WindowFrame& frame, const SE3& T_imu_vehicle) {
  const Eigen::Vector3d lever = T_imu_vehicle.translation();
  return frame.state.v_odom + frame.state.R_odom_imu * (frame.gyro - frame.bias.gyro).cross(lever);
}

VioEstimator::Impl::Impl(const Rig& rig, const VioOptions& options)
    : options_(options),
      inertial_noise_(toldNoise(rig.imu), options.imu_noise_factor),
      features_(options) {
  noise_ = inertial_noise_.noise();
  gap_ns_ = fromSeconds(options.max_imu_gap_s);
  T_vehicle_imu_ = rig.imu.T_vehicle_imu;
  const SE3 T_imu_vehicle = T_vehicle_imu_.inverse();
  window_.T_imu_vehicle = T_imu_vehicle;
  window_.gravity.vector = Eigen::Vector3d(0.0, 0.0, -options.gravity);
  for (const RigCamera& camera : rig.cameras) {
    window_.cameras.push_back(
        {camera.camera, T_imu_vehicle * camera.T_vehicle_cam, 0.0, camera.readout_time});
  }
  const VioCalibrationOptions& calibration = options.calibration;
  // A single camera that sits elsewhere looks much like an inertial unit that does.
  const bool refine_extrinsics = calibration.refine_extrinsics && window_.cameras.size() > 1;
  const bool rolling = std::any_of(rig.cameras.begin(), rig.cameras.end(),
                                   [](const RigCamera& c) { return c.readout_time > 0.0; });
  if (refine_extrinsics || calibration.refine_time_offset ||
      (calibration.refine_readout_time && rolling)) {
    // What is not refined is held by a prior that nothing outweighs.
    const double rotation = calibration.rotation_sigma_deg * std::numbers::pi / 180.0;
    for (const RigCamera& camera : rig.cameras) {
      CameraRefinement refinement;
      refinement.prior_T_imu_cam = T_imu_vehicle * camera.T_vehicle_cam;
      refinement.prior_readout_time = camera.readout_time;
      refinement.sigma.setConstant(kHeldCalibration);
      if (refine_extrinsics) {
        // Those that the rig tells are held: a rig that a drive has found errs in what no picture
        // shows, and would be taken for exact in that, too, for what its pictures show is right.
        const bool told = camera.position_sigma > 0.0 && camera.rotation_sigma > 0.0;
        refinement.sigma.head<3>().setConstant(told ? camera.position_sigma
                                                    : calibration.position_sigma);
        refinement.sigma.segment<3>(3).setConstant(told ? camera.rotation_sigma : rotation);
        learns_sigmas_ = learns_sigmas_ && !told;
      }
      if (calibration.refine_time_offset) refinement.sigma(6) = calibration.time_sigma;
      if (calibration.refine_readout_time && camera.readout_time > 0.0) {
        refinement.sigma(7) = calibration.readout_sigma;
      }
      window_.refinements.push_back(refinement);
    }
  }
  learns_sigmas_ = learns_sigmas_ && calibration.learn_sigmas;
  is_car_ = rig.vehicle.has_value();
  if (rig.vehicle) wheel_track_ = rig.vehicle->track;
}

void VioEstimator::Impl::addImu(const ImuSample& sample) {
  if (!readings_.add({sample.t_ns, sample.gyro, sample.accel})) {
    logWarning(
        "IMU reading at {} ns dropped: not newer than the last one, not finite, or beyond what a "
        "vehicle does",
        sample.t_ns);
    return;
  }
  const std::optional<TimeNs> isolated = readings_.dropIsolated();
  if (!isolated) return;
  if (!told_of_isolated_) {
    told_of_isolated_ = true;
    logWarning(
        "IMU reading at {} ns left out: it stands apart from those before and after it, as a "
        "broken transfer does; others like it are left out silently",
        *isolated);
  }
  for (std::size_t i = 1; i < window_.frames.size(); ++i) {
    const bool before_end = *isolated < window_.frames[i].t_ns + kReach;
    const bool after_begin = *isolated + kReach > window_.frames[i - 1].t_ns;
    if (before_end && after_begin) window_.frames[i].imu_outdated = true;
  }
}

void VioEstimator::Impl::addWheel(const WheelSample& sample) {
  if (!wheels_.empty() && sample.t_ns <= wheels_.back().t_ns) return;
  wheels_.push_back(sample);
  while (wheels_.front().t_ns + kNsPerSecond < sample.t_ns) wheels_.pop_front();
}

PoseEstimate VioEstimator::Impl::addTracks(const TrackSet& tracks) {
  if (has_frame && tracks.t_ns <= last_t_ns) {
    logWarning("frame set at {} ns ignored: not newer than the last one at {} ns", tracks.t_ns,
               last_t_ns);
    return last_;
  }
  statistics = {};
  has_frame = true;
  last_t_ns = tracks.t_ns;
  if (!initialised_) {
    last_ = startUp(tracks);
  } else {
    addFrame(tracks);
    if (initialised_) {
      last_ = estimate();
      // The pose is out; the window is made ready for the next frame.
      trimWindow();
    }
  }
  dropOldReadings(tracks.t_ns);
  return last_;
}

void VioEstimator::Impl::dropOldReadings(TimeNs now_ns) {
  TimeNs keep = now_ns - fromSeconds(kKeepReadings);
  if (!window_.frames.empty()) {
    keep = std::min(keep, window_.frames.front().t_ns);
  } else {
    // Before a start.
    keep -= fromSeconds(options_.standstill.window_s);
    if (!start_frames_.empty()) keep = std::min(keep, start_frames_.front().t_ns);
  }
  readings_.dropBefore(keep);
  statistics.imu_readings = static_cast<int>(readings_.size());
}

SolveOptions VioEstimator::Impl::solveOptions(int max_iterations) const {
  SolveOptions solve;
  solve.max_iterations = max_iterations;
  solve.loss.views = {RobustLoss::Kernel::kCauchy, options_.window.cauchy};
  return solve;
}

void VioEstimator::Impl::optimise(const SolveOptions& options) {
  const std::vector<WindowFeature*> selected = features_.select(window_);
  // A car at rest teaches nothing about where it was: what it sees again and again is only noise.
  const int rest = still_ ? window_.indexOf(still_anchor_id_) : -1;
  const bool held = rest >= 0 && rest + 1 < static_cast<int>(window_.frames.size());
  const SolveSummary summary =
      held ? solveAtRest(window_, selected, static_cast<std::size_t>(rest) + 1, options)
           : solveWindow(window_, selected, options);
  if (summary.has_covariance) {
    newest_covariance_ = summary.newest_covariance;
    global_covariance_ = summary.global_covariance;
    // The trials of a start would learn from each other.
    if (options_.calibration.learn_sigmas && initialised_ && !held) {
      learnCalibrationSpread(window_, global_covariance_, learns_sigmas_);
    }
  }
  int keyframes = 0;
  for (const WindowFrame& frame : window_.frames) keyframes += frame.keyframe ? 1 : 0;
  statistics.frames = static_cast<int>(window_.frames.size());
  statistics.keyframes = keyframes;
  statistics.span_s = toSeconds(window_.frames.back().t_ns - window_.frames.front().t_ns);
  statistics.landmarks = static_cast<int>(selected.size());
  statistics.observations = summary.observations;
  statistics.iterations = summary.iterations;
  const int newest = window_.frames.back().id;
  statistics.rejected_observations = features_.rejectOutliers(window_, selected);
  solved_landmarks_ = 0;
  for (const auto& [id, feature] : window_.features) {
    if (feature.selected && feature.has_point && feature.last_seen_id == newest) {
      ++solved_landmarks_;
    }
  }
}

void VioEstimator::Impl::addBodyVelocity(WindowFrame& frame) const {
  if (options_.use_no_side_slip && is_car_) {
    const double turning = (frame.gyro - frame.bias.gyro).norm();
    const double sideways = turning * frame.state.v_odom.norm();  // acceleration, m/s^2
    frame.body_velocity_sigma.y() =
        std::hypot(options_.side_slip_sigma, options_.side_slip_in_curves * sideways);
  }
  if (options_.use_planar) frame.body_velocity_sigma.z() = options_.planar_sigma;
  if (!options_.use_wheel || wheels_.empty()) return;
  // The newest reading at or before the frame, or the first after it.
  const WheelSample* best = nullptr;
  for (const WheelSample& sample : wheels_) {
    if (best == nullptr || std::abs(static_cast<double>(sample.t_ns - frame.t_ns)) <
                               std::abs(static_cast<double>(best->t_ns - frame.t_ns))) {
      best = &sample;
    }
  }
  if (std::abs(toSeconds(best->t_ns - frame.t_ns)) > options_.wheel_max_age_s) return;
  const double left = best->rear_left_mps;
  const double right = best->rear_right_mps;
  double speed = 0.0;
  if (std::isfinite(left) && std::isfinite(right)) {
    speed = 0.5 * (left + right);
  } else if (std::isfinite(left) || std::isfinite(right)) {
    const Eigen::Vector3d rate =
        T_vehicle_imu_.rotation() * Eigen::Vector3d(frame.gyro - frame.bias.gyro);
    const double offset = 0.5 * wheel_track_ * rate.z();
    speed = std::isfinite(left) ? left + offset : right - offset;
  } else {
    return;
  }
  frame.body_velocity.x() = speed;
  frame.body_velocity_sigma.x() = options_.wheel_sigma;
}

void VioEstimator::Impl::updateHealth(const TrackSet& tracks, const GateResult& gate) {
  const WindowFrame& newest = window_.frames.back();
  const bool sane = newest.state.p_odom.allFinite() && newest.state.v_odom.allFinite() &&
                    newest.state.v_odom.norm() < kSaneSpeed &&
                    newest.bias.gyro.norm() < kSaneBiasGyro &&
                    newest.bias.accel.norm() < kSaneBiasAccel;
  if (!sane) {
    restart("the estimate diverged");
    return;
  }
  if (solved_landmarks_ >= kMinTrackedLandmarks || still_) last_vision_ns_ = newest.t_ns;
  const double blind = toSeconds(newest.t_ns - last_vision_ns_);
  const double gap = newest.imu ? newest.imu->gapDuration() : 0.0;
  health_ = Health::kTracking;
  reason_.clear();
  if (blind > options_.max_blind_s && !still_) {
    health_ = Health::kLost;
    reason_ = fmt::format("no images for {:.1f} s, the position is dead reckoning only", blind);
  } else if (solved_landmarks_ < kMinTrackedLandmarks && !still_) {
    health_ = Health::kDegraded;
    reason_ = blind > 0.0 ? fmt::format("dead reckoning: {} known features in view for {:.1f} s",
                                        solved_landmarks_, blind)
                          : fmt::format("{} known features in view", solved_landmarks_);
  } else if (gap > 0.0) {
    health_ = Health::kDegraded;
    reason_ = fmt::format("no IMU readings for {:.2f} s", gap);
  } else if (gate.contradicted) {
    health_ = Health::kDegraded;
    reason_ = "most cameras contradict the IMU readings";
  } else if (!gate.cameras.empty()) {
    health_ = Health::kDegraded;
    reason_ = "moving objects fill the view of camera";
    for (const int camera : gate.cameras) reason_ += fmt::format(" {}", camera);
  } else {
    for (std::size_t c = 0; c < tracks.camera_ok.size(); ++c) {
      if (tracks.camera_ok[c] != 0) continue;
      health_ = Health::kDegraded;
      reason_ += (reason_.empty() ? "no usable image from camera " : " ") + std::to_string(c);
    }
  }
}

VioEstimator::VioEstimator(const Rig& rig, const VioOptions& options)
    : impl_(std::make_unique<Impl>(rig, options)) {}
VioEstimator::~VioEstimator() = default;
VioEstimator::VioEstimator(VioEstimator&&) noexcept = default;
VioEstimator& VioEstimator::operator=(VioEstimator&&) noexcept = default;

void VioEstimator::addImu(const ImuSample& sample) {
  impl_->addImu(sample);
}
void VioEstimator::addWheel(const WheelSample& sample) {
  impl_->addWheel(sample);
}
PoseEstimate VioEstimator::addTracks(const TrackSet& tracks) {
  return impl_->addTracks(tracks);
}
MotionPrior VioEstimator::predict(TimeNs t_ns) const {
  if (!impl_->has_frame || t_ns < impl_->last_t_ns) return {};
  return predictor().predict(impl_->last_t_ns, t_ns);
}
MotionPredictor VioEstimator::predictor() const {
  return impl_->predictor();
}
std::vector<Landmark> VioEstimator::landmarks() const {
  return impl_->landmarks();
}
RigSigma VioEstimator::rigSigma() const {
  return impl_->rigSigma();
}
std::vector<CameraCalibrationEstimate> VioEstimator::calibration() const {
  return impl_->calibration();
}
Trajectory VioEstimator::finalTrajectory() const {
  return impl_->finalTrajectory();
}
const VioStatistics& VioEstimator::statistics() const {
  return impl_->statistics;
}

}  // namespace parkade
