// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/imu/preintegration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"

namespace parkade {
namespace {

using Eigen::Vector3d;

constexpr TimeNs kGapNs = 100 * kNsPerMs;
const Vector3d kGravity(0.0, 0.0, -9.81);

// A smooth motion with known derivatives.
NavState truthAt(double t) {
  NavState s;
  s.p_odom = Vector3d(2.0 * std::sin(0.7 * t), 1.5 * std::cos(0.9 * t), 0.3 * std::sin(1.3 * t));
  s.v_odom = Vector3d(1.4 * std::cos(0.7 * t), -1.35 * std::sin(0.9 * t), 0.39 * std::cos(1.3 * t));
  s.R_odom_imu =
      SO3::fromYawPitchRoll(0.8 * std::sin(0.6 * t), 0.2 * std::sin(1.1 * t), 0.3 * std::cos(t));
  return s;
}

ImuReading readingAt(double t, const ImuBias& bias) {
  const Vector3d accel(-0.98 * std::sin(0.7 * t), -1.215 * std::cos(0.9 * t),
                       -0.507 * std::sin(1.3 * t));
  const double h = 1e-4;
  const SO3 R = truthAt(t).R_odom_imu;
  ImuReading reading;
  reading.t_ns = fromSeconds(t);
  reading.gyro =
      (truthAt(t - h).R_odom_imu.inverse() * truthAt(t + h).R_odom_imu).log() / (2.0 * h) +
      bias.gyro;
  reading.accel = R.inverse() * (accel - kGravity) + bias.accel;
  return reading;
}

std::vector<ImuReading> readings(double begin, double end, double dt, const ImuBias& bias) {
  std::vector<ImuReading> result;
  const int steps = static_cast<int>(std::lround((end - begin) / dt));
  for (int i = 0; i <= steps; ++i) result.push_back(readingAt(begin + i * dt, bias));
  return result;
}

const ImuBias kBias{Vector3d(0.02, -0.01, 0.03), Vector3d(0.1, -0.2, 0.05)};

NavState perturbed(const NavState& s, const Vector15d& d) {
  return {s.R_odom_imu * SO3::exp(d.segment<3>(3)), s.p_odom + d.segment<3>(0),
          s.v_odom + d.segment<3>(6)};
}

ImuBias perturbed(const ImuBias& b, const Vector15d& d) {
  return {b.gyro + d.segment<3>(9), b.accel + d.segment<3>(12)};
}

TEST(Preintegration, FollowsASmoothMotionWithoutNoise) {
  Preintegration sum(ImuNoise{}, kBias);
  sum.integrate(readings(1.0, 3.0, 0.005, kBias), kGapNs);
  const NavState end = sum.propagate(truthAt(1.0), kBias, kGravity);
  const NavState truth = truthAt(3.0);
  EXPECT_NEAR(sum.duration(), 2.0, 1e-9);
  EXPECT_LT((end.p_odom - truth.p_odom).norm(), 5e-5);
  EXPECT_LT((end.v_odom - truth.v_odom).norm(), 5e-5);
  EXPECT_LT(angleBetween(end.R_odom_imu, truth.R_odom_imu), 2e-5);
  const Vector15d r = sum.residual(truthAt(1.0), kBias, truth, kBias, kGravity);
  EXPECT_LT(r.norm(), 1e-4);
}

TEST(Preintegration, MidpointErrorFallsWithTheSquareOfTheStep) {
  double error[2];
  for (int i = 0; i < 2; ++i) {
    Preintegration sum(ImuNoise{}, kBias);
    sum.integrate(readings(0.0, 2.0, i == 0 ? 0.01 : 0.005, kBias), kGapNs);
    error[i] = (sum.propagate(truthAt(0.0), kBias, kGravity).p_odom - truthAt(2.0).p_odom).norm();
  }
  EXPECT_NEAR(error[0] / error[1], 4.0, 0.4);
}

TEST(Preintegration, BiasJacobiansPredictAnotherBias) {
  ImuBias other = kBias;
  other.gyro += Vector3d(1e-3, -2e-3, 1.5e-3);
  other.accel += Vector3d(-0.02, 0.01, 0.03);
  const std::vector<ImuReading> data = readings(0.0, 0.5, 0.005, kBias);
  Preintegration at_bias(ImuNoise{}, kBias);
  at_bias.integrate(data, kGapNs);
  Preintegration at_other(ImuNoise{}, other);
  at_other.integrate(data, kGapNs);
  const NavState exact = at_other.propagate(truthAt(0.0), other, kGravity);
  const NavState first_order = at_bias.propagate(truthAt(0.0), other, kGravity);
  const NavState ignored = at_bias.propagate(truthAt(0.0), kBias, kGravity);
  EXPECT_LT((first_order.p_odom - exact.p_odom).norm(), 5e-6);
  EXPECT_GT((ignored.p_odom - exact.p_odom).norm(), 1e-3);
  EXPECT_LT((first_order.v_odom - exact.v_odom).norm(), 2e-5);
  EXPECT_LT(angleBetween(first_order.R_odom_imu, exact.R_odom_imu), 1e-6);
}

TEST(Preintegration, ResidualJacobiansAreThoseOfFiniteDifferences) {
  Random random(3);
  Preintegration sum(ImuNoise{}, kBias);
  sum.integrate(readings(0.0, 0.6, 0.005, kBias), kGapNs);
  const auto draw = [&](double scale) {
    Vector15d d;
    for (int i = 0; i < 15; ++i) d(i) = scale * random.normal();
    return d;
  };
  const Vector15d d_begin = draw(0.03);
  const Vector15d d_end = draw(0.03);
  const NavState begin = perturbed(truthAt(0.0), d_begin);
  const NavState end = perturbed(truthAt(0.6), d_end);
  const ImuBias bias_begin = perturbed(kBias, d_begin);
  const ImuBias bias_end = perturbed(kBias, d_end);
  Matrix15d j_begin;
  Matrix15d j_end;
  (void)sum.residual(begin, bias_begin, end, bias_end, kGravity, &j_begin, &j_end);
  const double h = 1e-6;
  for (int i = 0; i < 15; ++i) {
    const Vector15d d = h * Vector15d::Unit(i);
    const Vector15d by_begin =
        (sum.residual(perturbed(begin, d), perturbed(bias_begin, d), end, bias_end, kGravity) -
         sum.residual(perturbed(begin, -d), perturbed(bias_begin, -d), end, bias_end, kGravity)) /
        (2.0 * h);
    const Vector15d by_end =
        (sum.residual(begin, bias_begin, perturbed(end, d), perturbed(bias_end, d), kGravity) -
         sum.residual(begin, bias_begin, perturbed(end, -d), perturbed(bias_end, -d), kGravity)) /
        (2.0 * h);
    EXPECT_LT((by_begin - j_begin.col(i)).norm(), 1e-7) << "begin " << i;
    EXPECT_LT((by_end - j_end.col(i)).norm(), 1e-7) << "end " << i;
  }
}

TEST(Preintegration, CovarianceIsThatOfManyNoisyRuns) {
  ImuNoise noise;
  noise.gyroscope_noise_density = 2e-3;
  noise.accelerometer_noise_density = 2e-2;
  noise.gyroscope_random_walk = 1e-3;
  noise.accelerometer_random_walk = 1e-2;
  const double dt = 0.005;
  const std::vector<ImuReading> clean = readings(0.0, 1.0, dt, kBias);
  Preintegration exact(noise, kBias);
  exact.integrate(clean, kGapNs);
  Random random(11);
  constexpr int kRuns = 1500;
  Matrix15d sampled = Matrix15d::Zero();
  double mean_nees = 0.0;
  const Matrix15d information = exact.covariance().inverse();
  for (int run = 0; run < kRuns; ++run) {
    std::vector<ImuReading> noisy = clean;
    Vector3d walk_gyro = Vector3d::Zero();
    Vector3d walk_accel = Vector3d::Zero();
    const auto normals = [&] {
      return Vector3d(random.normal(), random.normal(), random.normal());
    };
    for (std::size_t i = 0; i < noisy.size(); ++i) {
      noisy[i].gyro += walk_gyro + noise.gyroscope_noise_density / std::sqrt(dt) * normals();
      noisy[i].accel += walk_accel + noise.accelerometer_noise_density / std::sqrt(dt) * normals();
      if (i + 1 == noisy.size()) break;
      walk_gyro += noise.gyroscope_random_walk * std::sqrt(dt) * normals();
      walk_accel += noise.accelerometer_random_walk * std::sqrt(dt) * normals();
    }
    Preintegration sum(noise, kBias);
    sum.integrate(noisy, kGapNs);
    Vector15d error;
    error.segment<3>(0) = sum.deltaPosition() - exact.deltaPosition();
    error.segment<3>(3) = (exact.deltaRotation().inverse() * sum.deltaRotation()).log();
    error.segment<3>(6) = sum.deltaVelocity() - exact.deltaVelocity();
    // The summed-up motion errs as if the bias had been the walk's; the sign is the walk's.
    error.segment<3>(9) = -walk_gyro;
    error.segment<3>(12) = -walk_accel;
    error = -error;
    sampled += error * error.transpose() / kRuns;
    mean_nees += error.dot(information * error) / kRuns;
  }
  // 15 degrees of freedom: the mean of 1500 lies within 15 +- 0.43 with 99.9 %.
  EXPECT_NEAR(mean_nees, 15.0, 0.6);
  for (int i = 0; i < 15; ++i) {
    EXPECT_NEAR(sampled(i, i) / exact.covariance()(i, i), 1.0, 0.15) << i;
  }
}

TEST(Preintegration, GapRaisesTheCovarianceAndIsCounted) {
  const ImuReading a = readingAt(0.0, kBias);
  const ImuReading b = readingAt(0.3, kBias);
  Preintegration step(ImuNoise{}, kBias);
  step.integrate(a, b, kNsPerSecond);
  Preintegration gap(ImuNoise{}, kBias);
  gap.integrate(a, b, kGapNs);
  EXPECT_DOUBLE_EQ(step.gapDuration(), 0.0);
  EXPECT_DOUBLE_EQ(gap.gapDuration(), 0.3);
  EXPECT_GT(gap.covariance()(6, 6), 100.0 * step.covariance()(6, 6));
  EXPECT_THROW(gap.integrate(b, a, kGapNs), CheckError);
}

}  // namespace
}  // namespace parkade
