// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/factors.hpp"

namespace parkade {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {
constexpr int kP = Preintegration::kPosition;
constexpr int kR = Preintegration::kRotation;
constexpr int kV = Preintegration::kVelocity;
constexpr int kG = Preintegration::kBiasGyro;
constexpr int kA = Preintegration::kBiasAccel;

}  // namespace

Vector15d imuResidual(const WindowFrame& begin, const WindowFrame& end,
                      const WindowGravity& gravity, Matrix15d* d_res_d_begin,
                      Matrix15d* d_res_d_end, Matrix15x2d* d_res_d_gravity) {
  const Preintegration& imu = *end.imu;
  const auto whiten = end.imu_sqrt_information.triangularView<Eigen::Lower>();
  const Vector15d r =
      whiten * imu.residual(begin.state, begin.bias, end.state, end.bias, gravity.vector);
  if (d_res_d_begin != nullptr && d_res_d_end != nullptr && d_res_d_gravity != nullptr) {
    // All at the first estimates, so that a common motion of frames and gravity has no effect.
    Matrix15d by_begin;
    Matrix15d by_end;
    (void)imu.residual(begin.jacobianState(), begin.jacobianBias(), end.jacobianState(),
                       end.jacobianBias(), gravity.jacobianVector(), &by_begin, &by_end);
    const double t = imu.duration();
    const Eigen::Matrix<double, 3, 2> pull =
        begin.jacobianState().R_odom_imu.matrix().transpose() * gravity.basis();
    Matrix15x2d by_gravity = Matrix15x2d::Zero();
    by_gravity.middleRows<3>(kP) = -0.5 * t * t * pull;
    by_gravity.middleRows<3>(kV) = -t * pull;
    *d_res_d_begin = whiten * by_begin;
    *d_res_d_end = whiten * by_end;
    *d_res_d_gravity = whiten * by_gravity;
  }
  return r;
}

Vector9d stillResidual(const WindowFrame& rest, const WindowFrame& now, const StillSigma& sigma,
                       Matrix9x15d* d_res_d_rest, Matrix9x15d* d_res_d_now) {
  const SO3 turned = rest.state.R_odom_imu.inverse() * now.state.R_odom_imu;
  Vector9d r;
  r.segment<3>(0) = (now.state.p_odom - rest.state.p_odom) / sigma.position;
  r.segment<3>(3) = turned.log() / sigma.rotation;
  r.segment<3>(6) = now.state.v_odom / sigma.velocity;
  if (d_res_d_rest != nullptr && d_res_d_now != nullptr) {
    const SO3 turned_lin =
        rest.jacobianState().R_odom_imu.inverse() * now.jacobianState().R_odom_imu;
    const Matrix3d inverse_jacobian = SO3::rightJacobianInverse(turned_lin.log());
    d_res_d_rest->setZero();
    d_res_d_now->setZero();
    d_res_d_rest->block<3, 3>(0, kP) = -Matrix3d::Identity() / sigma.position;
    d_res_d_now->block<3, 3>(0, kP) = Matrix3d::Identity() / sigma.position;
    d_res_d_rest->block<3, 3>(3, kR) =
        -inverse_jacobian * turned_lin.matrix().transpose() / sigma.rotation;
    d_res_d_now->block<3, 3>(3, kR) = inverse_jacobian / sigma.rotation;
    d_res_d_now->block<3, 3>(6, kV) = Matrix3d::Identity() / sigma.velocity;
  }
  return r;
}

Vector3d bodyVelocityResidual(const WindowFrame& frame, const SE3& T_imu_vehicle,
                              Matrix3x15d* d_res_d_frame) {
  Vector3d weight = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (frame.body_velocity_sigma(i) > 0.0) weight(i) = 1.0 / frame.body_velocity_sigma(i);
  }
  const Matrix3d R_vehicle_imu = T_imu_vehicle.rotation().matrix().transpose();
  const Vector3d& lever = T_imu_vehicle.translation();
  const Vector3d v_imu = frame.state.R_odom_imu.inverse() * frame.state.v_odom;
  const Vector3d v_origin = v_imu + (frame.gyro - frame.bias.gyro).cross(lever);
  const Vector3d r = weight.asDiagonal() * (R_vehicle_imu * v_origin - frame.body_velocity);
  if (d_res_d_frame != nullptr) {
    const NavState& lin = frame.jacobianState();
    const Matrix3d whiten = weight.asDiagonal() * R_vehicle_imu;
    const Matrix3d Rt = lin.R_odom_imu.matrix().transpose();
    d_res_d_frame->setZero();
    d_res_d_frame->block<3, 3>(0, kR) = whiten * hat(Rt * lin.v_odom);
    d_res_d_frame->block<3, 3>(0, kV) = whiten * Rt;
    d_res_d_frame->block<3, 3>(0, kG) = whiten * hat(lever);
  }
  return r;
}

Vector15d startResidual(const WindowFrame& frame, const StartPrior& prior,
                        Matrix15d* d_res_d_frame) {
  Vector15d weight = Vector15d::Zero();
  for (int i = 0; i < 15; ++i) {
    if (prior.sigma(i) > 0.0) weight(i) = 1.0 / prior.sigma(i);
  }
  const Vector3d turned = (frame.state.R_odom_imu * prior.state.R_odom_imu.inverse()).log();
  Vector15d r;
  r.segment<3>(kP) = frame.state.p_odom - prior.state.p_odom;
  r.segment<3>(kR) = turned;
  r.segment<3>(kV) = frame.state.v_odom - prior.state.v_odom;
  r.segment<3>(kG) = frame.bias.gyro - prior.bias.gyro;
  r.segment<3>(kA) = frame.bias.accel - prior.bias.accel;
  r.array() *= weight.array();
  if (d_res_d_frame != nullptr) {
    const SO3& lin = frame.jacobianState().R_odom_imu;
    const Vector3d turned_lin = (lin * prior.state.R_odom_imu.inverse()).log();
    d_res_d_frame->setIdentity();
    d_res_d_frame->block<3, 3>(kR, kR) = SO3::leftJacobianInverse(turned_lin) * lin.matrix();
    *d_res_d_frame = weight.asDiagonal() * *d_res_d_frame;
  }
  return r;
}

CalibrationVector calibrationResidual(const VioCamera& camera, const CameraRefinement& refinement,
                                      CalibrationMatrix* d_res_d_camera) {
  const Vector3d turned =
      (refinement.prior_T_imu_cam.rotation().inverse() * camera.T_imu_cam.rotation()).log();
  CalibrationVector r;
  r << camera.T_imu_cam.translation() - refinement.prior_T_imu_cam.translation(), turned,
      camera.time_offset - refinement.prior_time_offset,
      camera.readout_time - refinement.prior_readout_time;
  const CalibrationVector weight = refinement.sigma.cwiseInverse();
  if (d_res_d_camera != nullptr) {
    d_res_d_camera->setIdentity();
    d_res_d_camera->block<3, 3>(3, 3) = SO3::rightJacobianInverse(turned);
    *d_res_d_camera = weight.asDiagonal() * *d_res_d_camera;
  }
  return weight.cwiseProduct(r);
}

Eigen::Vector2d gravityResidual(const WindowGravity& gravity, const StartPrior& prior,
                                Eigen::Matrix2d* d_res_d_gravity) {
  const double weight = prior.gravity_sigma > 0.0 ? 1.0 / prior.gravity_sigma : 0.0;
  const double magnitude = prior.gravity.norm();
  const Eigen::Matrix<double, 3, 2> across = tangentBasis(prior.gravity / magnitude);
  if (d_res_d_gravity != nullptr) {
    *d_res_d_gravity = weight / magnitude * across.transpose() * gravity.basis();
  }
  return weight / magnitude * across.transpose() * (gravity.vector - prior.gravity);
}

}  // namespace parkade
