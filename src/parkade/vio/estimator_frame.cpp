// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// How a frame set enters the window.
#include <cmath>

#include "parkade/core/log.hpp"
#include "parkade/vio/estimator_impl.hpp"
#include "parkade/vio/factors.hpp"

namespace parkade {
namespace {

constexpr int kMinTellers = 50;            // landmarks in view, to learn from readings
constexpr double kSettledPosition = 0.01;  // m, a step that needs no second one
constexpr double kSettledRotation = 1e-3;  // rad
constexpr double kSameNoise = 0.15;        // sums are not renewed for less

}  // namespace

void VioEstimator::Impl::setImu(WindowFrame& frame, TimeNs begin_ns, const ImuBias& bias) const {
  if (readings_.empty()) return;
  const Preintegration sum =
      readings_.sumBetween(begin_ns, frame.t_ns, inertial_noise_.noise(), bias, gap_ns_);
  frame.imu_noise_factor = inertial_noise_.factor();
  frame.imu_outdated = readings_.lastTime() < frame.t_ns;
  frame.imu = sum;
  frame.imu_sqrt_information = sqrtInformation(sum);
}

// Readings that were missing at a frame may have come since, or turned out to be broken.
void VioEstimator::Impl::sumOutdatedAgain() {
  const double factor = inertial_noise_.factor();
  for (std::size_t i = 1; i < window_.frames.size(); ++i) {
    WindowFrame& frame = window_.frames[i];
    if (!frame.imu) continue;
    const bool renew = std::abs(factor / frame.imu_noise_factor - 1.0) > kSameNoise;
    if (!frame.imu_outdated && !renew) continue;
    setImu(frame, window_.frames[i - 1].t_ns, frame.imu->bias());
  }
}

void VioEstimator::Impl::learnInertialNoise() {
  const std::size_t count = window_.frames.size();
  if (count < 3) return;
  const WindowFrame& begin = window_.frames[count - 3];
  const WindowFrame& frame = window_.frames[count - 2];
  if (!frame.imu || frame.imu->gapDuration() > 0.0 || frame.still_since >= 0) return;
  if (begin.cameras == 0 || frame.cameras == 0 || solved_landmarks_ < kMinTellers) return;
  const Vector15d residual = imuResidual(begin, frame, window_.gravity, nullptr, nullptr, nullptr);
  inertial_noise_.learn(residual, frame.imu_noise_factor);
}

Eigen::Matrix<double, 6, 6> VioEstimator::Impl::predictFrame(WindowFrame& frame,
                                                             const WindowFrame& previous) const {
  setImu(frame, previous.t_ns, previous.bias);
  frame.bias = previous.bias;
  frame.state = frame.imu->propagate(previous.state, previous.bias, window_.gravity.vector);
  frame.gyro = readings_.at(frame.t_ns).gyro;
  addBodyVelocity(frame);

  // How far the prediction may be off relative to the frame before it.
  Matrix15d spread = newest_covariance_;
  const Eigen::Matrix3d R = previous.state.R_odom_imu.matrix();
  Matrix15d to_local = Matrix15d::Identity();
  to_local.block<3, 3>(0, 0) = R.transpose();
  to_local.block<3, 3>(6, 6) = R.transpose();
  spread.topRows<6>().setZero();
  spread.leftCols<6>().setZero();
  spread = to_local * spread * to_local.transpose();
  const Matrix15d F = frame.imu->transition();
  spread = F * spread * F.transpose() + frame.imu->covariance();
  Eigen::Matrix<double, 6, 6> pose_spread = spread.topLeftCorner<6, 6>();
  pose_spread.topRows<3>() = R * pose_spread.topRows<3>();
  pose_spread.leftCols<3>() = pose_spread.leftCols<3>() * R.transpose();
  return pose_spread;
}

// Where most cameras contradict the prediction, readings that jump are left out for good, and it is
// made anew.
GateResult VioEstimator::Impl::gateNewest(const Eigen::Matrix<double, 6, 6>& spread) {
  const GateResult gate = features_.gateNewest(window_, spread);
  if (!gate.contradicted) return gate;
  const std::size_t count = window_.frames.size();
  WindowFrame& frame = window_.frames[count - 1];
  WindowFrame& previous = window_.frames[count - 2];
  const int dropped = readings_.dropSpikes(previous.t_ns, frame.t_ns);
  // Once more without a reading that explains it: what moves is what most cameras see.
  if (dropped == 0) {
    return statistics.contradicted ? features_.gateNewest(window_, spread, true) : gate;
  }
  logWarning("{} IMU reading(s) before {} ns left out: they jump, and most cameras contradict them",
             dropped, frame.t_ns);
  // A reading just after the frame before had a part in that, too.
  if (previous.imu && count > 2) {
    setImu(previous, window_.frames[count - 3].t_ns, previous.imu->bias());
  }
  return features_.gateNewest(window_, predictFrame(frame, previous));
}

void VioEstimator::Impl::addFrame(const TrackSet& tracks) {
  sumOutdatedAgain();
  WindowFrame frame;
  frame.id = next_id_++;
  frame.t_ns = tracks.t_ns;
  const Observations observations =
      FeatureManager::observationsOf(window_.cameras, tracks, frame.id);
  frame.cameras = camerasOf(observations);
  frame.steady_cameras = frame.cameras & window_.frames.back().cameras;
  const Eigen::Matrix<double, 6, 6> spread = predictFrame(frame, window_.frames.back());
  detectStandstill(frame, observations);
  window_.frames.push_back(frame);
  features_.add(window_, observations);
  const GateResult gate = gateNewest(spread);
  rememberTracks(observations, tracks.t_ns);
  // Points would be placed by a motion that is not the car's.
  if (!gate.contradicted) features_.triangulateNew(window_);
  SolveOptions solve = solveOptions(options_.window.max_iterations);
  solve.settled_position = kSettledPosition;
  solve.settled_rotation = kSettledRotation;
  optimise(solve);
  learnInertialNoise();
  statistics.imu_noise_factor = inertial_noise_.factor();
  statistics.rejected_observations += gate.rejected;
  statistics.rejected_cameras = gate.cameras;
  statistics.contradicted = gate.contradicted;
  statistics.standstill = still_;
  updateHealth(tracks, gate);
}

}  // namespace parkade
