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

// How a frame moves when the whole window turns about the vertical, at its point of linearisation.
Vector15d headingDirection(const WindowFrame& frame) {
  const NavState& lin = frame.jacobianState();
  const Vector3d up = Vector3d::UnitZ();
  Vector15d n = Vector15d::Zero();
  n.segment<3>(kP) = up.cross(lin.p_odom);
  n.segment<3>(kR) = lin.R_odom_imu.inverse() * up;
  n.segment<3>(kV) = up.cross(lin.v_odom);
  return n;
}

// Readings are so sharp that Jacobians at an old point of linearisation mislead the solver (they
// contradict the present state by many sigmas once tilt and bias are corrected). They are taken at
// the present state instead, and freed of the one thing that this would make up: knowledge of the
// heading. The rotation columns of the first frame take the difference, so that a turn of the
// window about the vertical at its points of linearisation has no effect at all; displacements have
// none by themselves. docs/math/marginalisation.md, eq. (5).
void holdHeading(const WindowFrame& begin, const WindowFrame& end, Matrix15d& by_begin,
                 Matrix15d& by_end) {
  if (begin.linearised) {
    by_begin.middleCols<3>(kR) *= SO3::rightJacobian(begin.delta.segment<3>(kR));
  }
  if (end.linearised) {
    by_end.middleCols<3>(kR) *= SO3::rightJacobian(end.delta.segment<3>(kR));
  }
  const Vector15d n_begin = headingDirection(begin);
  const Vector15d effect = by_begin * n_begin + by_end * headingDirection(end);
  by_begin.middleCols<3>(kR) -= effect * n_begin.segment<3>(kR).transpose();
}
}  // namespace

Vector15d imuResidual(const WindowFrame& begin, const WindowFrame& end, const Vector3d& gravity,
                      Matrix15d* d_res_d_begin, Matrix15d* d_res_d_end) {
  const Preintegration& imu = *end.imu;
  const Vector15d r = end.imu_sqrt_information *
                      imu.residual(begin.state, begin.bias, end.state, end.bias, gravity);
  if (d_res_d_begin != nullptr && d_res_d_end != nullptr) {
    Matrix15d by_begin;
    Matrix15d by_end;
    (void)imu.residual(begin.state, begin.bias, end.state, end.bias, gravity, &by_begin, &by_end);
    if (begin.linearised || end.linearised) {
      holdHeading(begin, end, by_begin, by_end);
    }
    const auto whiten = end.imu_sqrt_information.triangularView<Eigen::Lower>();
    *d_res_d_begin = whiten * by_begin;
    *d_res_d_end = whiten * by_end;
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

}  // namespace parkade
