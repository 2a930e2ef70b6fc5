// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/imu/preintegration.hpp"

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kP = Preintegration::kPosition;
constexpr int kR = Preintegration::kRotation;
constexpr int kV = Preintegration::kVelocity;
constexpr int kG = Preintegration::kBiasGyro;
constexpr int kA = Preintegration::kBiasAccel;

// The parts of one step's transition that are neither identity nor zero (eq. 4).
struct StepJacobian {
  Matrix3d rr, rg;      // rotation by rotation, gyro bias
  Matrix3d vr, vg, va;  // velocity by rotation, gyro bias, accelerometer bias
  double dt = 0.0;
};

// out = F * in, for the step's transition F; position follows velocity by dt / 2.
void multiplyLeft(const StepJacobian& f, const Matrix15d& in, Matrix15d& out) {
  out = in;
  const auto rotation = in.middleRows<3>(kR);
  const auto bias_gyro = in.middleRows<3>(kG);
  const auto bias_accel = in.middleRows<3>(kA);
  Eigen::Matrix<double, 3, 15> dv = f.vr * rotation;
  dv.noalias() += f.vg * bias_gyro;
  dv.noalias() += f.va * bias_accel;
  out.middleRows<3>(kP) += f.dt * in.middleRows<3>(kV) + 0.5 * f.dt * dv;
  out.middleRows<3>(kR).noalias() = f.rr * rotation;
  out.middleRows<3>(kR).noalias() += f.rg * bias_gyro;
  out.middleRows<3>(kV) += dv;
}

}  // namespace

void Preintegration::integrate(const ImuReading& begin, const ImuReading& end, TimeNs gap_ns) {
  PARKADE_CHECK(end.t_ns >= begin.t_ns, "readings go back in time: {} then {}", begin.t_ns,
                end.t_ns);
  if (end.t_ns == begin.t_ns) return;
  const double dt = toSeconds(end.t_ns - begin.t_ns);
  const bool gap = end.t_ns - begin.t_ns > gap_ns;

  // 1. The step itself, eqs. (1) to (3).
  const Vector3d rate = 0.5 * (begin.gyro + end.gyro) - bias_.gyro;
  const SO3 step = SO3::exp(rate * dt);
  const Matrix3d R0 = delta_rotation_.matrix();
  const Matrix3d step_matrix = step.matrix();
  const Matrix3d R1 = R0 * step_matrix;
  const Vector3d force0 = begin.accel - bias_.accel;
  const Vector3d force1 = end.accel - bias_.accel;
  const Vector3d accel = 0.5 * (R0 * force0 + R1 * force1);

  // 2. Its Jacobians, eq. (4).
  const Matrix3d right_jacobian = SO3::rightJacobian(rate * dt);
  const Matrix3d by_end = -0.5 * dt * R1 * hat(force1);
  StepJacobian f;
  f.dt = dt;
  f.rr = step_matrix.transpose();
  f.rg = -right_jacobian * dt;
  f.vr = -0.5 * dt * R0 * hat(force0) + by_end * f.rr;
  f.vg = by_end * f.rg;
  f.va = -0.5 * dt * (R0 + R1);

  // 3. Covariance F C F' + noise; the noise enters like a bias error does.
  const double gyro_variance =
      noise_.gyroscope_noise_density * noise_.gyroscope_noise_density / dt +
      (gap ? noise_.gap_gyro * noise_.gap_gyro : 0.0);
  const double accel_variance =
      noise_.accelerometer_noise_density * noise_.accelerometer_noise_density / dt +
      (gap ? noise_.gap_accel * noise_.gap_accel : 0.0);
  Eigen::Matrix<double, 15, 6> g = Eigen::Matrix<double, 15, 6>::Zero();
  g.block<3, 3>(kR, 0) = f.rg;
  g.block<3, 3>(kV, 0) = f.vg;
  g.block<3, 3>(kP, 0) = 0.5 * dt * f.vg;
  g.block<3, 3>(kV, 3) = f.va;
  g.block<3, 3>(kP, 3) = 0.5 * dt * f.va;
  Matrix15d half;
  multiplyLeft(f, covariance_, half);
  const Matrix15d half_transposed = half.transpose();
  multiplyLeft(f, half_transposed, covariance_);
  Eigen::Matrix<double, 15, 6> scaled = g;
  scaled.leftCols<3>() *= gyro_variance;
  scaled.rightCols<3>() *= accel_variance;
  covariance_.topLeftCorner<9, 9>().noalias() += scaled.topRows<9>() * g.topRows<9>().transpose();
  covariance_.diagonal().segment<3>(kG).array() +=
      noise_.gyroscope_random_walk * noise_.gyroscope_random_walk * dt;
  covariance_.diagonal().segment<3>(kA).array() +=
      noise_.accelerometer_random_walk * noise_.accelerometer_random_walk * dt;

  Matrix15d transition;
  multiplyLeft(f, transition_, transition);
  transition_ = transition;

  delta_position_ += delta_velocity_ * dt + 0.5 * dt * dt * accel;
  delta_velocity_ += accel * dt;
  delta_rotation_ = delta_rotation_ * step;
  duration_ += dt;
  if (gap) gap_duration_ += dt;
}

void Preintegration::integrate(std::span<const ImuReading> readings, TimeNs gap_ns) {
  for (std::size_t i = 0; i + 1 < readings.size(); ++i) {
    integrate(readings[i], readings[i + 1], gap_ns);
  }
}

Preintegration::Corrected Preintegration::corrected(const ImuBias& bias) const {
  const Vector3d d_gyro = bias.gyro - bias_.gyro;
  const Vector3d d_accel = bias.accel - bias_.accel;
  Corrected c;
  c.rotation_correction = transition_.block<3, 3>(kR, kG) * d_gyro;
  c.rotation = delta_rotation_ * SO3::exp(c.rotation_correction);
  c.velocity = delta_velocity_ + transition_.block<3, 3>(kV, kG) * d_gyro +
               transition_.block<3, 3>(kV, kA) * d_accel;
  c.position = delta_position_ + transition_.block<3, 3>(kP, kG) * d_gyro +
               transition_.block<3, 3>(kP, kA) * d_accel;
  return c;
}

NavState Preintegration::propagate(const NavState& begin, const ImuBias& bias,
                                   const Vector3d& gravity) const {
  const Corrected delta = corrected(bias);
  NavState end;
  end.R_odom_imu = begin.R_odom_imu * delta.rotation;
  end.v_odom = begin.v_odom + gravity * duration_ + begin.R_odom_imu * delta.velocity;
  end.p_odom = begin.p_odom + begin.v_odom * duration_ + 0.5 * duration_ * duration_ * gravity +
               begin.R_odom_imu * delta.position;
  return end;
}

Vector15d Preintegration::residual(const NavState& begin, const ImuBias& bias_begin,
                                   const NavState& end, const ImuBias& bias_end,
                                   const Vector3d& gravity, Matrix15d* d_res_d_begin,
                                   Matrix15d* d_res_d_end) const {
  const Corrected delta = corrected(bias_begin);
  const Matrix3d Rt = begin.R_odom_imu.matrix().transpose();
  const double dt = duration_;
  const Vector3d moved =
      Rt * (end.p_odom - begin.p_odom - begin.v_odom * dt - 0.5 * dt * dt * gravity);
  const Vector3d gained = Rt * (end.v_odom - begin.v_odom - gravity * dt);
  const SO3 turned = begin.R_odom_imu.inverse() * end.R_odom_imu;
  const Vector3d rotation_residual = (delta.rotation.inverse() * turned).log();

  Vector15d r;
  r.segment<3>(kP) = moved - delta.position;
  r.segment<3>(kR) = rotation_residual;
  r.segment<3>(kV) = gained - delta.velocity;
  r.segment<3>(kG) = bias_end.gyro - bias_begin.gyro;
  r.segment<3>(kA) = bias_end.accel - bias_begin.accel;

  if (d_res_d_begin == nullptr && d_res_d_end == nullptr) return r;
  const Matrix3d inverse_jacobian = SO3::rightJacobianInverse(rotation_residual);
  if (d_res_d_begin != nullptr) {
    Matrix15d& j = *d_res_d_begin;
    j.setZero();
    j.block<3, 3>(kP, kP) = -Rt;
    j.block<3, 3>(kP, kR) = hat(moved);
    j.block<3, 3>(kP, kV) = -Rt * dt;
    j.block<3, 3>(kP, kG) = -transition_.block<3, 3>(kP, kG);
    j.block<3, 3>(kP, kA) = -transition_.block<3, 3>(kP, kA);
    j.block<3, 3>(kR, kR) = -inverse_jacobian * turned.matrix().transpose();
    j.block<3, 3>(kR, kG) = -inverse_jacobian * SO3::exp(rotation_residual).matrix().transpose() *
                            SO3::rightJacobian(delta.rotation_correction) *
                            transition_.block<3, 3>(kR, kG);
    j.block<3, 3>(kV, kR) = hat(gained);
    j.block<3, 3>(kV, kV) = -Rt;
    j.block<3, 3>(kV, kG) = -transition_.block<3, 3>(kV, kG);
    j.block<3, 3>(kV, kA) = -transition_.block<3, 3>(kV, kA);
    j.block<3, 3>(kG, kG) = -Matrix3d::Identity();
    j.block<3, 3>(kA, kA) = -Matrix3d::Identity();
  }
  if (d_res_d_end != nullptr) {
    Matrix15d& j = *d_res_d_end;
    j.setZero();
    j.block<3, 3>(kP, kP) = Rt;
    j.block<3, 3>(kR, kR) = inverse_jacobian;
    j.block<3, 3>(kV, kV) = Rt;
    j.block<3, 3>(kG, kG) = Matrix3d::Identity();
    j.block<3, 3>(kA, kA) = Matrix3d::Identity();
  }
  return r;
}

}  // namespace parkade
