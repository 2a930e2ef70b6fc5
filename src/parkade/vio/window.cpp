// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/window.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

void add(const Vector15d& step, NavState& state, ImuBias& bias) {
  state.p_odom += step.segment<3>(Preintegration::kPosition);
  state.R_odom_imu = state.R_odom_imu * SO3::exp(step.segment<3>(Preintegration::kRotation));
  state.v_odom += step.segment<3>(Preintegration::kVelocity);
  bias.gyro += step.segment<3>(Preintegration::kBiasGyro);
  bias.accel += step.segment<3>(Preintegration::kBiasAccel);
}

}  // namespace

void WindowFrame::apply(const Vector15d& step) {
  if (linearised) {
    // Steps add up in the tangent space of the one point that all Jacobians are taken at.
    delta += step;
    state = lin_state;
    bias = lin_bias;
    add(delta, state, bias);
  } else {
    add(step, state, bias);
  }
}

void WindowFrame::fixLinearisation() {
  if (linearised) return;
  linearised = true;
  lin_state = state;
  lin_bias = bias;
  delta.setZero();
}

Eigen::Matrix<double, 3, 2> WindowGravity::basis() const {
  const double magnitude = jacobianVector().norm();
  return magnitude * tangentBasis(jacobianVector() / magnitude);
}

void WindowGravity::apply(const Eigen::Vector2d& step) {
  const Eigen::Vector3d from = jacobianVector();
  const double magnitude = from.norm();
  if (linearised) delta += step;
  const Eigen::Vector3d moved = from + basis() * (linearised ? delta : step);
  vector = magnitude * moved.normalized();
}

void WindowGravity::fixLinearisation() {
  if (linearised) return;
  linearised = true;
  lin_vector = vector;
  delta.setZero();
}

Eigen::Index Window::globalSize() const {
  return cameraGlobal(refinements.size());
}

Eigen::VectorXd Window::globalDelta() const {
  Eigen::VectorXd delta(globalSize());
  delta.head<2>() = gravity.delta;
  for (std::size_t c = 0; c < refinements.size(); ++c) {
    delta.segment<kCalibration>(cameraGlobal(c)) = refinements[c].delta;
  }
  return delta;
}

void Window::applyGlobals(const Eigen::VectorXd& step) {
  gravity.apply(step.head<2>());
  for (std::size_t c = 0; c < refinements.size(); ++c) {
    CameraRefinement& refinement = refinements[c];
    VioCamera& camera = cameras[c];
    CalibrationVector move = step.segment<kCalibration>(cameraGlobal(c));
    SE3 from = camera.T_imu_cam;
    double offset = camera.time_offset;
    double readout = camera.readout_time;
    if (refinement.linearised) {
      refinement.delta += move;
      move = refinement.delta;
      from = refinement.lin_T_imu_cam;
      offset = refinement.lin_time_offset;
      readout = refinement.lin_readout_time;
    }
    camera.T_imu_cam =
        SE3(from.rotation() * SO3::exp(move.segment<3>(3)), from.translation() + move.head<3>());
    camera.time_offset = offset + move(6);
    camera.readout_time = readout + move(7);
  }
}

void Window::fixGlobals() {
  gravity.fixLinearisation();
  for (std::size_t c = 0; c < refinements.size(); ++c) {
    CameraRefinement& refinement = refinements[c];
    if (refinement.linearised) continue;
    refinement.linearised = true;
    refinement.lin_T_imu_cam = cameras[c].T_imu_cam;
    refinement.lin_time_offset = cameras[c].time_offset;
    refinement.lin_readout_time = cameras[c].readout_time;
    refinement.delta.setZero();
  }
}

std::uint64_t camerasOf(const Observations& observations) {
  std::uint64_t cameras = 0;
  for (const auto& [id, o] : observations) cameras |= std::uint64_t{1} << (o.camera & 63);
  return cameras;
}

int Window::indexOf(int frame_id) const {
  const auto it = std::lower_bound(frames.begin(), frames.end(), frame_id,
                                   [](const WindowFrame& frame, int id) { return frame.id < id; });
  if (it == frames.end() || it->id != frame_id) return -1;
  return static_cast<int>(it - frames.begin());
}

WindowFrame* Window::find(int frame_id) {
  const int index = indexOf(frame_id);
  return index < 0 ? nullptr : &frames[static_cast<std::size_t>(index)];
}

const WindowFrame* Window::find(int frame_id) const {
  const int index = indexOf(frame_id);
  return index < 0 ? nullptr : &frames[static_cast<std::size_t>(index)];
}

Eigen::Vector3d Window::pointOf(const WindowFeature& feature) const {
  const WindowFrame* anchor = find(feature.anchor_frame_id);
  PARKADE_CHECK(anchor != nullptr, "feature {} has no anchor frame {}", feature.id,
                feature.anchor_frame_id);
  const Eigen::Vector3d p_imu = cameras[static_cast<std::size_t>(feature.anchor_camera)].T_imu_cam *
                                Eigen::Vector3d(feature.direction / feature.inverse_distance);
  return anchor->state.R_odom_imu * p_imu + anchor->state.p_odom;
}

Eigen::Vector2d observedPixel(const Window& window, const WindowObservation& observation) {
  const double late = window.cameras[static_cast<std::size_t>(observation.camera)].time_offset;
  return observation.pixel - late * observation.pixel_rate;
}

Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& direction) {
  // Duff et al., "Building an Orthonormal Basis, Revisited", 2017.
  const double sign = std::copysign(1.0, direction.z());
  const double a = -1.0 / (sign + direction.z());
  const double b = direction.x() * direction.y() * a;
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) << 1.0 + sign * direction.x() * direction.x() * a, sign * b, -sign * direction.x();
  basis.col(1) << b, sign + direction.y() * direction.y() * a, -direction.y();
  return basis;
}

bool moveAnchor(const Window& window, WindowFeature& feature, const WindowObservation& to) {
  const WindowFrame* from_frame = window.find(feature.anchor_frame_id);
  const WindowFrame* to_frame = window.find(to.frame_id);
  PARKADE_CHECK(from_frame != nullptr && to_frame != nullptr, "anchor {} to {}",
                feature.anchor_frame_id, to.frame_id);
  const SE3& T_imu_from = window.cameras[static_cast<std::size_t>(feature.anchor_camera)].T_imu_cam;
  const SE3& T_imu_to = window.cameras[static_cast<std::size_t>(to.camera)].T_imu_cam;
  const SE3 T_to_from =
      (SE3(to_frame->state.R_odom_imu, to_frame->state.p_odom) * T_imu_to).inverse() *
      SE3(from_frame->state.R_odom_imu, from_frame->state.p_odom) * T_imu_from;
  const Eigen::Vector3d scaled =
      T_to_from.rotation() * feature.direction + feature.inverse_distance * T_to_from.translation();
  const double length = scaled.norm();
  if (length < 1e-3) return false;
  feature.direction = scaled / length;
  feature.inverse_distance = feature.inverse_distance / length;
  feature.anchor_frame_id = to.frame_id;
  feature.anchor_camera = to.camera;
  return true;
}

Matrix15d sqrtInformation(const Preintegration& imu) {
  Matrix15d covariance = imu.covariance();
  covariance.diagonal().segment<3>(Preintegration::kPosition).array() += 1e-12;
  covariance.diagonal().segment<3>(Preintegration::kRotation).array() += 1e-14;
  covariance.diagonal().segment<3>(Preintegration::kVelocity).array() += 1e-12;
  covariance.diagonal().segment<3>(Preintegration::kBiasGyro).array() += 1e-16;
  covariance.diagonal().segment<3>(Preintegration::kBiasAccel).array() += 1e-14;
  Eigen::LLT<Matrix15d> llt(covariance);
  // After seconds without readings position, velocity and biases are correlated to the last digit.
  for (double loading = 1e-12; llt.info() != Eigen::Success && loading < 1e-3; loading *= 10.0) {
    Matrix15d loaded = covariance;
    loaded.diagonal() *= 1.0 + loading;
    llt.compute(loaded);
  }
  PARKADE_CHECK(llt.info() == Eigen::Success, "covariance of {} s of IMU readings is not positive",
                imu.duration());
  return llt.matrixL().solve(Matrix15d::Identity());
}

}  // namespace parkade
