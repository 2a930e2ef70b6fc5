// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/fusion/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/units.hpp"
#include "parkade/geometry/se2.hpp"

namespace parkade {

DeadReckoning::DeadReckoning(const SE3& T_vehicle_imu, const DeadReckoningOptions& options)
    : T_vehicle_imu_(T_vehicle_imu), options_(options) {}

void DeadReckoning::addImu(const ImuSample& sample) {
  if (!sample.gyro.allFinite() || !sample.accel.allFinite()) return;
  if (!imu_.empty() && sample.t_ns <= imu_.back().t_ns) return;
  // Nobody knows what the car did before its wheels are heard.
  constexpr TimeNs kWait = kNsPerSecond;
  if (speeds_.empty() && !imu_.empty() && sample.t_ns - imu_.front().t_ns > kWait) imu_.pop_front();
  imu_.push_back(sample);
}

void DeadReckoning::addWheel(const WheelSample& sample) {
  const bool left = std::isfinite(sample.rear_left_mps);
  const bool right = std::isfinite(sample.rear_right_mps);
  if (!left && !right) return;
  if (!speeds_.empty() && sample.t_ns <= speeds_.back().t_ns) return;
  const double mps = left && right ? 0.5 * (sample.rear_left_mps + sample.rear_right_mps)
                     : left        ? sample.rear_left_mps
                                   : sample.rear_right_mps;
  speeds_.push_back({sample.t_ns, mps});
}

double DeadReckoning::speedAt(TimeNs t_ns) const {
  if (t_ns <= speeds_.front().t_ns) return speeds_.front().mps;
  for (std::size_t i = 1; i < speeds_.size(); ++i) {
    if (speeds_[i].t_ns < t_ns) continue;
    const Speed& a = speeds_[i - 1];
    const Speed& b = speeds_[i];
    const double share = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
    return a.mps + share * (b.mps - a.mps);
  }
  return speeds_.back().mps;
}

void DeadReckoning::stand(const Eigen::Vector3d& gyro, const Eigen::Vector3d& accel, double dt) {
  still_s_ += dt;
  // The body rocks after it stops.
  constexpr double kSettle = 0.3;
  if (still_s_ < kSettle && way_ > 0.0) return;
  bias_seconds_ += dt;
  constexpr double kMemory = 30.0;  // s; the bias wanders
  const double share = dt / std::min(bias_seconds_, kMemory);
  bias_ += share * (gyro - bias_);
  if (accel.norm() > 1.0) {
    up_ = (up_ + std::min(1.0, 2.0 * share) * (accel.normalized() - up_)).normalized();
  }
  bias_t_ns_ = t_ns_;
}

void DeadReckoning::advance(const ImuSample& sample, TimeNs until) {
  const double dt = toSeconds(until - t_ns_);
  if (dt <= 0.0) return;
  const SO3& R = T_vehicle_imu_.rotation();
  const Eigen::Vector3d gyro = R * sample.gyro;
  const Eigen::Vector3d accel = R * sample.accel;
  const double speed = speedAt(t_ns_ + (until - t_ns_) / 2);
  const double step = speed * dt;
  const bool still = std::abs(speed) < options_.still_mps;
  if (still) {
    stand(gyro, accel, dt);
  } else {
    still_s_ = 0.0;
  }
  const Eigen::Vector3d rate = still ? Eigen::Vector3d::Zero() : Eigen::Vector3d(gyro - bias_);
  const double yaw_rate = rate.dot(up_);
  if (!still) levelUp(rate, accel, speed, dt);
  last_speed_ = speed;
  const SE2 increment = SE2::exp({step, 0.0, yaw_rate * dt});
  const SE2 pose = SE2(yaw_, position_) * increment;
  yaw_ = pose.angle();
  position_ = pose.translation();
  way_ += std::abs(step);
  const Eigen::Matrix3d F = increment.inverse().adjoint();
  covariance_ = F * covariance_ * F.transpose() + silenceNoise(sample.t_ns, until, dt);
  if (!still) covariance_.diagonal() += drivingNoise(std::abs(step), until, dt);
  t_ns_ = until;
}

void DeadReckoning::levelUp(const Eigen::Vector3d& rate, const Eigen::Vector3d& accel, double speed,
                            double dt) {
  // Gravity turns in the vehicle against the car's own turn; what the accelerometer feels beside it
  // is the wheels' acceleration and the curve's.
  const double yaw_rate = rate.dot(up_);
  up_ = (SO3::exp(-rate * dt) * up_).normalized();
  const Eigen::Vector3d motion((speed - last_speed_) / dt, speed * yaw_rate, 0.0);
  const Eigen::Vector3d felt = accel - motion;
  if (felt.norm() <= 1.0) return;
  const double share = std::min(1.0, dt / options_.attitude_s);
  up_ = (up_ + share * (felt.normalized() - up_)).normalized();
}

Eigen::Vector3d DeadReckoning::drivingNoise(double step, TimeNs until, double dt) const {
  // What stays the same over the drive (wheel radius, bias) grows with the square of way and time.
  const double bias_sigma =
      kDegree * (bias_seconds_ > 0.0 ? std::hypot(options_.bias_floor_deg_s,
                                                  options_.gyro_density_deg /
                                                      std::sqrt(std::min(bias_seconds_, 30.0)))
                                     : options_.bias_unknown_deg_s);
  const TimeNs since = bias_seconds_ > 0.0 ? bias_t_ns_ : origin_t_ns_;
  const double walk = square(options_.side_sigma) * step;
  return {walk + 2.0 * square(options_.scale_sigma) * way_ * step, walk,
          square(kDegree * options_.gyro_density_deg) * dt +
              2.0 * square(bias_sigma) * toSeconds(until - since) * dt};
}

Eigen::Matrix3d DeadReckoning::silenceNoise(TimeNs last_imu, TimeNs until, double dt) const {
  // What the car may do unnoticed while a sensor is silent: its variance is that of the whole
  // silence.
  constexpr double kUnseenTurn = 0.5;   // rad/s
  constexpr double kUnseenAccel = 1.0;  // m/s^2
  const auto silence = [&](TimeNs last) {
    const double seconds = toSeconds(until - last);
    return seconds > options_.max_silence_s ? seconds : 0.0;
  };
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  if (const double s = silence(last_imu); s > 0.0) {
    Q(2, 2) += square(kUnseenTurn) * (square(s) - square(std::max(0.0, s - dt)));
  }
  if (const double s = silence(speeds_.back().t_ns); s > 0.0) {
    Q(0, 0) += square(0.5 * kUnseenAccel) * (std::pow(s, 4) - std::pow(std::max(0.0, s - dt), 4));
  }
  return Q;
}

void DeadReckoning::start() {
  t_ns_ = std::max(imu_.front().t_ns, speeds_.front().t_ns);
  while (imu_.size() > 1 && imu_[1].t_ns <= t_ns_) imu_.pop_front();
  origin_t_ns_ = bias_t_ns_ = t_ns_;
  const Eigen::Vector3d accel = T_vehicle_imu_.rotation() * imu_.front().accel;
  if (accel.norm() > 1.0) up_ = accel.normalized();
  started_ = true;
}

PoseEstimate DeadReckoning::poseAt(TimeNs t_ns) {
  PoseEstimate e;
  e.t_ns = t_ns;
  e.health = Health::kInitialising;
  if (imu_.empty() || speeds_.empty()) {
    e.reason = imu_.empty() ? "no reading of the inertial unit yet" : "no wheel speed yet";
    return e;
  }
  if (!started_) start();
  const auto still_starting = [&] {
    return way_ < 1e-3 && bias_seconds_ < options_.start_s &&
           std::abs(last_speed_) < options_.still_mps;
  };
  const bool starting = still_starting();
  while (!imu_.empty() && t_ns_ < t_ns) {
    const bool last = imu_.size() == 1;
    advance(imu_.front(), last ? t_ns : std::min(t_ns, imu_[1].t_ns));
    if (last || imu_[1].t_ns > t_ns) break;
    imu_.pop_front();
  }
  while (speeds_.size() > 1 && speeds_[1].t_ns < t_ns) speeds_.pop_front();
  if (starting && still_starting()) {
    e.reason = "the car stands: learning the gyroscope's bias";
    return e;
  }
  const bool no_wheels = toSeconds(t_ns - speeds_.back().t_ns) > options_.max_silence_s;
  const bool no_imu = toSeconds(t_ns - imu_.front().t_ns) > options_.max_silence_s;
  e.health = no_wheels || no_imu ? Health::kLost : Health::kTracking;
  if (no_wheels) {
    e.reason = "the wheels are silent";
  } else if (no_imu) {
    e.reason = "the inertial unit is silent";
  }
  tellPose(e);
  return e;
}

void DeadReckoning::tellPose(PoseEstimate& e) const {
  const double pitch = std::atan2(-up_.x(), std::hypot(up_.y(), up_.z()));
  const double roll = std::atan2(up_.y(), up_.z());
  e.T_odom_vehicle =
      SE3(SO3::fromYawPitchRoll(yaw_, pitch, roll), {position_.x(), position_.y(), 0.0});
  e.velocity_odom = last_speed_ * Eigen::Vector3d(std::cos(yaw_), std::sin(yaw_), 0.0);
  e.bias_gyro = T_vehicle_imu_.rotation().inverse() * bias_;
  constexpr double kTilt = 0.01;     // rad
  constexpr double kHeight = 0.003;  // m / sqrt(m)
  Matrix6d level = Matrix6d::Zero();
  constexpr int kAt[3] = {0, 1, 5};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) level(kAt[i], kAt[j]) = covariance_(i, j);
  }
  // The floor is taken for flat, and the first pose for level.
  level(2, 2) = square(kHeight) * (1.0 + way_) + square(kTilt) * position_.squaredNorm();
  level(3, 3) = level(4, 4) = square(kTilt);
  const Eigen::Matrix3d R = SO3::fromYawPitchRoll(0.0, pitch, roll).inverse().matrix();
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = R;
  turn.bottomRightCorner<3, 3>() = R;
  e.covariance.topLeftCorner<6, 6>() = turn * level * turn.transpose();
}

}  // namespace parkade
