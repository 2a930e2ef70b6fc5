// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// What the estimator tells of its state.
#include <algorithm>

#include "parkade/vio/estimator_impl.hpp"
#include "parkade/vio/rig_error.hpp"

namespace parkade {

PoseEstimate VioEstimator::Impl::estimate() const {
  const WindowFrame& frame = window_.frames.back();
  PoseEstimate result;
  result.t_ns = frame.t_ns;
  result.T_odom_vehicle = SE3(frame.state.R_odom_imu, frame.state.p_odom) * window_.T_imu_vehicle;
  result.velocity_odom = originVelocity(frame, window_.T_imu_vehicle);
  result.up_odom = -window_.gravity.vector.normalized();
  result.bias_gyro = frame.bias.gyro;
  result.bias_accel = frame.bias.accel;
  result.health = health_;
  result.reason = reason_;

  // From (p_imu in odom axes, right rotation of the imu, ...) to the vehicle's tangent.
  const Eigen::Matrix3d R_odom_imu = frame.state.R_odom_imu.matrix();
  const Eigen::Matrix3d R_vehicle_imu = T_vehicle_imu_.rotation().matrix();
  const Eigen::Matrix3d R_vehicle_odom = R_vehicle_imu * R_odom_imu.transpose();
  const Eigen::Vector3d lever = window_.T_imu_vehicle.translation();
  Matrix15d J = Matrix15d::Identity();
  J.block<3, 3>(0, 0) = R_vehicle_odom;
  J.block<3, 3>(0, 3) = -R_vehicle_imu * hat(lever);
  J.block<3, 3>(3, 3) = R_vehicle_imu;
  J.block<3, 3>(6, 3) = -R_odom_imu * hat((frame.gyro - frame.bias.gyro).cross(lever));
  J.block<3, 3>(6, 9) = R_odom_imu * hat(lever);
  result.covariance = J * newest_covariance_ * J.transpose();
  return result;
}

MotionPredictor VioEstimator::Impl::predictor() const {
  MotionPredictor predictor;
  if (!initialised_ || window_.frames.empty()) return predictor;
  const WindowFrame& newest = window_.frames.back();
  predictor.valid_ = true;
  predictor.t_ns_ = newest.t_ns;
  predictor.state_ = newest.state;
  predictor.bias_ = newest.bias;
  predictor.gravity_ = window_.gravity.vector;
  predictor.T_vehicle_imu_ = T_vehicle_imu_;
  for (const ImuReading& reading :
       readings_.between(newest.t_ns, std::max(newest.t_ns, readings_.lastTime()))) {
    (void)predictor.readings_.add(reading);
  }
  for (const auto& [id, feature] : window_.features) {
    if (!feature.has_point || feature.last_seen_id + 2 < newest.id) continue;
    if (feature.inverse_distance < 1e-3) continue;
    predictor.points_odom_.emplace_back(id, window_.pointOf(feature));
  }
  for (const VioCamera& camera : window_.cameras) {
    predictor.readout_times_.push_back(toldReadoutTime(camera));
  }
  return predictor;
}

std::vector<Landmark> VioEstimator::Impl::landmarks() const {
  std::vector<Landmark> result;
  if (!initialised_) return result;
  for (const auto& [id, feature] : window_.features) {
    if (!feature.has_point || !feature.selected || feature.inverse_distance < 1e-3) continue;
    Landmark landmark;
    landmark.id = id;
    landmark.p_odom = window_.pointOf(feature);
    landmark.num_observations = static_cast<int>(feature.observations.size());
    landmark.covariance = landmarkCovariance(window_, feature);
    result.push_back(landmark);
  }
  return result;
}

Trajectory VioEstimator::Impl::finalTrajectory() const {
  return history_.trajectory(window_);
}

std::vector<CameraCalibrationEstimate> VioEstimator::Impl::calibration() const {
  std::vector<CameraCalibrationEstimate> result;
  for (std::size_t c = 0; c < window_.refinements.size(); ++c) {
    CameraCalibrationEstimate estimate;
    estimate.T_vehicle_cam = T_vehicle_imu_ * window_.cameras[c].T_imu_cam;
    estimate.time_offset = window_.cameras[c].time_offset;
    estimate.readout_time = toldReadoutTime(window_.cameras[c]);
    estimate.sigma = window_.refinements[c].sigma;
    if (initialised_ && global_covariance_.rows() == window_.globalSize()) {
      estimate.sigma =
          global_covariance_.diagonal().segment<kCalibration>(Window::cameraGlobal(c)).cwiseSqrt();
    }
    for (Eigen::Index i = 0; i < estimate.sigma.size(); ++i) {
      if (window_.refinements[c].sigma(i) <= kHeldCalibration) estimate.sigma(i) = 0.0;
    }
    result.push_back(estimate);
  }
  return result;
}

RigSigma VioEstimator::Impl::rigSigma() const {
  if (!initialised_ || global_covariance_.rows() != window_.globalSize()) return {};
  const auto cameras = static_cast<Eigen::Index>(window_.refinements.size());
  const Eigen::Matrix3d R_vehicle_imu = T_vehicle_imu_.rotation().matrix();
  std::vector<Eigen::Vector3d> places;
  std::vector<Eigen::Matrix3d> axes;  // turns are told about the camera's own axes
  for (const VioCamera& camera : window_.cameras) {
    places.push_back(camera.T_imu_cam.translation());
    axes.push_back(R_vehicle_imu * camera.T_imu_cam.rotation().matrix());
  }
  places.resize(window_.refinements.size());
  Eigen::MatrixXd of_places(3 * cameras, 3 * cameras);
  Eigen::MatrixXd of_turns(3 * cameras, 3 * cameras);
  for (Eigen::Index a = 0; a < cameras; ++a) {
    const auto ka = static_cast<std::size_t>(a);
    for (Eigen::Index b = 0; b < cameras; ++b) {
      const auto kb = static_cast<std::size_t>(b);
      const auto both =
          global_covariance_.block<6, 6>(Window::cameraGlobal(ka), Window::cameraGlobal(kb));
      of_places.block<3, 3>(3 * a, 3 * b) = both.topLeftCorner<3, 3>();
      of_turns.block<3, 3>(3 * a, 3 * b) =
          axes[ka] * both.bottomRightCorner<3, 3>() * axes[kb].transpose();
    }
  }
  return {lengthSigma(places, of_places), commonTurnSigma(of_turns)};
}

}  // namespace parkade
