// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/imu_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "parkade/imu/preintegration.hpp"

namespace parkade::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// A minute of corners, a stop, a bump, a slope and a rough road.
struct Drive {
  Path path;
  SpeedProfile profile;
  VehicleMotion motion;

  static Path makePath() {
    PathLeg leg;
    leg.vertices = {{0, 0}, {40, 0}, {40, 35}, {5, 35}, {5, 70}, {60, 70}, {80, 75}, {120, 75}};
    return std::move(buildPath({leg})).value();
  }
  static double height(const Eigen::Vector2d& p) {
    const double s = (p.x() - 20.0) / 0.175;
    const double slope = 0.3 * std::sin(p.y() / 12.0);
    return slope + (std::abs(s) < 1.0 ? 0.04 * std::pow(1 - s * s, 3) : 0.0);
  }
  Drive()
      : path(makePath()),
        profile(path, {{30.0, 2.0}}, {{15.0, 25.0, 2.0}}, {}),
        motion(path, profile, height, {}) {}
};

const SE3 kMount(SO3::fromYawPitchRoll(0.1, -0.05, 3.0), {1.1, -0.2, 0.45});

std::vector<ImuSample> idealSamples(const VehicleMotion& motion, int count) {
  std::vector<ImuSample> samples;
  for (int i = 0; i < count; ++i) {
    samples.push_back(idealImu(motion.at(i * 0.005), kMount, i * 5 * kNsPerMs));
  }
  return samples;
}

struct Navigation {
  SO3 R_world_imu;
  Eigen::Vector3d velocity;
  Eigen::Vector3d position;
};

Navigation truthAt(const VehicleMotion& motion, double t) {
  const MotionState state = motion.at(t);
  const SE3 pose = state.T_world_vehicle * kMount;
  return {pose.rotation(),
          state.velocity_world + state.T_world_vehicle.rotation() *
                                     state.angular_velocity_body.cross(kMount.translation()),
          pose.translation()};
}

const Eigen::Vector3d kGravity(0, 0, -9.81);

// Polynomial of degree 5 through samples k-2 .. k+3, for times in [0, 1] between k and k+1.
Eigen::Matrix<double, 6, 1> interpolated(const std::vector<ImuSample>& samples, int k, double x) {
  const int first = std::clamp(k - 2, 0, static_cast<int>(samples.size()) - 6);
  const double at = x + k - first;
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  for (int i = 0; i < 6; ++i) {
    double weight = 1.0;
    for (int j = 0; j < 6; ++j) {
      if (j != i) weight *= (at - j) / (i - j);
    }
    sum.head<3>() += weight * samples[first + i].gyro;
    sum.tail<3>() += weight * samples[first + i].accel;
  }
  return sum;
}

// Fourth-order integration of interpolated samples: what they contain, without a scheme's own
// error.
void integrateFinely(const std::vector<ImuSample>& samples, Navigation& nav) {
  constexpr int kSub = 4;
  const double h = 0.005 / kSub;
  for (int k = 0; k + 1 < static_cast<int>(samples.size()); ++k) {
    for (int sub = 0; sub < kSub; ++sub) {
      const auto a = interpolated(samples, k, (sub + 0.0) / kSub);
      const auto m = interpolated(samples, k, (sub + 0.5) / kSub);
      const auto b = interpolated(samples, k, (sub + 1.0) / kSub);
      const Eigen::Vector3d wa = a.head<3>(), wm = m.head<3>(), wb = b.head<3>();
      // Magnus expansion, Simpson's rule: error h^5.
      const auto rotation = [&](double dt, const Eigen::Vector3d& w0, const Eigen::Vector3d& w1,
                                const Eigen::Vector3d& w2) {
        return nav.R_world_imu *
               SO3::exp(dt / 6.0 * (w0 + 4.0 * w1 + w2) + dt * dt / 12.0 * w0.cross(w2));
      };
      const Eigen::Vector3d w_quarter = 0.375 * wa + 0.75 * wm - 0.125 * wb;
      const SO3 Rm = rotation(0.5 * h, wa, w_quarter, wm);
      const SO3 Rb = rotation(h, wa, wm, wb);
      const Eigen::Vector3d fa = nav.R_world_imu * Eigen::Vector3d(a.tail<3>()) + kGravity;
      const Eigen::Vector3d fm = Rm * Eigen::Vector3d(m.tail<3>()) + kGravity;
      const Eigen::Vector3d fb = Rb * Eigen::Vector3d(b.tail<3>()) + kGravity;
      nav.position += h * nav.velocity + h * h / 6.0 * (fa + 2.0 * fm);
      nav.velocity += h / 6.0 * (fa + 4.0 * fm + fb);
      nav.R_world_imu = Rb;
    }
  }
}

// The estimators' own scheme.
Navigation preintegrated(const std::vector<ImuSample>& samples, const Navigation& begin) {
  Preintegration sum;
  std::vector<ImuReading> readings;
  for (const ImuSample& sample : samples) {
    readings.push_back({sample.t_ns, sample.gyro, sample.accel});
  }
  sum.integrate(readings, kNsPerSecond);
  const NavState end =
      sum.propagate({begin.R_world_imu, begin.position, begin.velocity}, {}, kGravity);
  return {end.R_odom_imu, end.v_odom, end.p_odom};
}

TEST(IdealImu, IntegratesBackToTheTruthOverAMinute) {
  const Drive drive;
  constexpr int kCount = 12001;
  ASSERT_GT(drive.motion.duration(), 60.0);
  const std::vector<ImuSample> samples = idealSamples(drive.motion, kCount);
  const Navigation truth = truthAt(drive.motion, (kCount - 1) * 0.005);

  Navigation fine = truthAt(drive.motion, 0.0);
  integrateFinely(samples, fine);
  EXPECT_LT((fine.position - truth.position).norm(), 0.001);
  EXPECT_LT(angleBetween(fine.R_world_imu, truth.R_world_imu), 0.001 * kDegree);
  EXPECT_LT((fine.velocity - truth.velocity).norm(), 1e-4);
  RecordProperty("fine_mm", std::to_string(1e3 * (fine.position - truth.position).norm()));

  // The midpoint steps of the estimators do as well.
  const Navigation coarse = preintegrated(samples, truthAt(drive.motion, 0.0));
  EXPECT_LT((coarse.position - truth.position).norm(), 0.001);
  EXPECT_LT(angleBetween(coarse.R_world_imu, truth.R_world_imu), 0.001 * kDegree);
  RecordProperty("coarse_mm", std::to_string(1e3 * (coarse.position - truth.position).norm()));
}

TEST(IdealImu, FeelsGravityAtRest) {
  const Drive drive;
  const ImuSample sample = idealImu(drive.motion.at(0.0), SE3(), 0);
  EXPECT_NEAR(sample.accel.z(), 9.81, 0.02);
  EXPECT_NEAR(sample.gyro.norm(), 0.0, 1e-6);
}

// Overlapping Allan deviation of a rate series at an averaging time of m samples.
double allanDeviation(const std::vector<double>& rate, int m, double dt) {
  std::vector<double> angle(rate.size() + 1, 0.0);
  for (std::size_t i = 0; i < rate.size(); ++i) angle[i + 1] = angle[i] + rate[i] * dt;
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 2 * m < angle.size(); ++i, ++count) {
    const double d = angle[i + 2 * m] - 2.0 * angle[i + m] + angle[i];
    sum += d * d;
  }
  return std::sqrt(sum / (2.0 * m * dt * m * dt * static_cast<double>(count)));
}

struct RestingNoise {
  std::vector<double> gyro;
  std::vector<double> accel;
};

RestingNoise restingNoise(const ImuCalibration& calibration, int count, int axis) {
  NoisyImu noise(calibration, {}, Random(7));
  RestingNoise result;
  for (int i = 0; i < count; ++i) {
    const ImuSample sample = noise.corrupt({});
    result.gyro.push_back(sample.gyro[axis]);
    result.accel.push_back(sample.accel[axis]);
  }
  return result;
}

TEST(NoisyImu, AllanDeviationShowsTheWhiteNoise) {
  ImuCalibration calibration;
  calibration.gyroscope_random_walk = 0.0;
  calibration.accelerometer_random_walk = 0.0;
  const RestingNoise noise = restingNoise(calibration, 400000, 1);
  for (const double tau : {0.1, 1.0, 4.0}) {  // sigma(tau) = N / sqrt(tau)
    const int m = static_cast<int>(std::lround(tau * 200.0));
    EXPECT_NEAR(allanDeviation(noise.gyro, m, 0.005) * std::sqrt(tau),
                calibration.gyroscope_noise_density, 0.06 * calibration.gyroscope_noise_density);
    EXPECT_NEAR(allanDeviation(noise.accel, m, 0.005) * std::sqrt(tau),
                calibration.accelerometer_noise_density,
                0.06 * calibration.accelerometer_noise_density);
  }
}

TEST(NoisyImu, AllanDeviationShowsTheRandomWalk) {
  ImuCalibration calibration;
  calibration.gyroscope_noise_density = 0.0;
  calibration.accelerometer_noise_density = 0.0;
  const RestingNoise noise = restingNoise(calibration, 400000, 2);
  for (const double tau : {1.0, 5.0}) {  // sigma(tau) = K sqrt(tau / 3)
    const int m = static_cast<int>(std::lround(tau * 200.0));
    const double scale = std::sqrt(3.0 / tau);
    EXPECT_NEAR(allanDeviation(noise.gyro, m, 0.005) * scale, calibration.gyroscope_random_walk,
                0.1 * calibration.gyroscope_random_walk);
    EXPECT_NEAR(allanDeviation(noise.accel, m, 0.005) * scale,
                calibration.accelerometer_random_walk, 0.1 * calibration.accelerometer_random_walk);
  }
}

TEST(NoisyImu, TurnOnBiasHasTheSetSpread) {
  const ImuErrorOptions options;
  double gyro = 0.0;
  double accel = 0.0;
  constexpr int kParts = 2000;
  for (int i = 0; i < kParts; ++i) {
    const NoisyImu noise(ImuCalibration{}, options, Random(i));
    gyro += noise.gyroBias().squaredNorm() / 3.0 / kParts;
    accel += noise.accelBias().squaredNorm() / 3.0 / kParts;
  }
  EXPECT_NEAR(std::sqrt(gyro), options.gyro_turn_on_deg_s * kDegree, 2e-4);
  EXPECT_NEAR(std::sqrt(accel), options.accel_turn_on, 5e-3);
}

TEST(NoisyImu, OffGivesTheIdealSample) {
  ImuErrorOptions options;
  options.noise = false;
  NoisyImu noise(ImuCalibration{}, options, Random(1));
  const ImuSample ideal{5, {0.1, 0.2, 0.3}, {1, 2, 3}};
  EXPECT_EQ(noise.corrupt(ideal).gyro, ideal.gyro);
  EXPECT_EQ(noise.corrupt(ideal).accel, ideal.accel);
}

TEST(NoisyWheels, CountsDeadZoneAndScale) {
  const WheelErrorOptions options;
  const NoisyWheels noise(options, Random(3));
  const WheelSample slow = noise.corrupt({0.1, 0.1, 0.0}, 1);
  EXPECT_EQ(slow.rear_left_mps, 0.0);
  double sum = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double v = 1.0 + 0.003 * i;
    const WheelSample sample = noise.corrupt({-v, v, 0.2}, 1);
    EXPECT_LT(sample.rear_left_mps, 0.0);
    EXPECT_EQ(std::remainder(sample.rear_right_mps, 1.0 / 64.0), 0.0);
    EXPECT_NEAR(std::remainder(sample.steering_rad / kDegree, 0.1), 0.0, 1e-9);
    sum += sample.rear_right_mps / v / 1000;
  }
  EXPECT_NE(sum, 1.0);
  EXPECT_NEAR(sum, 1.0, 0.02);
}

}  // namespace
}  // namespace parkade::sim
