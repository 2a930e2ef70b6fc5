// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "parkade/imu/imu_types.hpp"

namespace parkade {

using Vector15d = Eigen::Matrix<double, 15, 1>;
using Matrix15d = Eigen::Matrix<double, 15, 15>;

/// IMU readings between two instants, summed up once so that the motion they mean can be compared
/// with any pair of states: Forster et al., "On-Manifold Preintegration for Real-Time
/// Visual-Inertial Odometry", 2017, with midpoint steps. See docs/math/preintegration.md.
///
/// Order everywhere: position 0, rotation 3 (right perturbation), velocity 6, gyro bias 9,
/// accelerometer bias 12.
class Preintegration {
 public:
  static constexpr int kPosition = 0;
  static constexpr int kRotation = 3;
  static constexpr int kVelocity = 6;
  static constexpr int kBiasGyro = 9;
  static constexpr int kBiasAccel = 12;

  Preintegration() = default;
  Preintegration(const ImuNoise& noise, const ImuBias& bias) : noise_(noise), bias_(bias) {}

  /// Adds the step between two readings in the order of time. Steps longer than gap_ns count as a
  /// gap: the mean reading is held and its noise raised to ImuNoise::gap_*.
  void integrate(const ImuReading& begin, const ImuReading& end, TimeNs gap_ns);
  /// All steps of consecutive readings.
  void integrate(std::span<const ImuReading> readings, TimeNs gap_ns);

  [[nodiscard]] double duration() const { return duration_; }         ///< s
  [[nodiscard]] double gapDuration() const { return gap_duration_; }  ///< s of it without readings
  [[nodiscard]] const ImuBias& bias() const { return bias_; }         ///< that was subtracted
  [[nodiscard]] const SO3& deltaRotation() const { return delta_rotation_; }
  [[nodiscard]] const Eigen::Vector3d& deltaVelocity() const { return delta_velocity_; }
  [[nodiscard]] const Eigen::Vector3d& deltaPosition() const { return delta_position_; }
  /// Of the end's (position, rotation, velocity, biases) given the begin's, by the readings' noise.
  [[nodiscard]] const Matrix15d& covariance() const { return covariance_; }
  /// How an error of the begin grows: d(end) / d(begin), both in the begin's axes (eq. 4 there).
  [[nodiscard]] const Matrix15d& transition() const { return transition_; }

  /// Where a state goes: exact for bias() and to first order for biases near it.
  [[nodiscard]] NavState propagate(const NavState& begin, const ImuBias& bias,
                                   const Eigen::Vector3d& gravity) const;

  /// What two states contradict the readings by (15), and by how much that changes with a right
  /// perturbation of each (rotation; all else additive in the odom frame), where asked.
  [[nodiscard]] Vector15d residual(const NavState& begin, const ImuBias& bias_begin,
                                   const NavState& end, const ImuBias& bias_end,
                                   const Eigen::Vector3d& gravity,
                                   Matrix15d* d_res_d_begin = nullptr,
                                   Matrix15d* d_res_d_end = nullptr) const;

 private:
  struct Corrected {
    SO3 rotation;
    Eigen::Vector3d velocity;
    Eigen::Vector3d position;
    Eigen::Vector3d rotation_correction;
  };
  [[nodiscard]] Corrected corrected(const ImuBias& bias) const;

  ImuNoise noise_;
  ImuBias bias_;
  SO3 delta_rotation_;
  Eigen::Vector3d delta_velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d delta_position_ = Eigen::Vector3d::Zero();
  Matrix15d covariance_ = Matrix15d::Zero();
  Matrix15d transition_ = Matrix15d::Identity();
  double duration_ = 0.0;
  double gap_duration_ = 0.0;
};

}  // namespace parkade
