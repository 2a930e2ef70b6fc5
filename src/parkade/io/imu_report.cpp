// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/imu_report.hpp"

#include <cmath>
#include <limits>

namespace parkade {
namespace {

// The quietest second of an IMU whose rows are in order.
void findQuietSecond(const std::vector<ImuSample>& samples, const SO3& R_vehicle_imu,
                     ImuReport& imu) {
  constexpr std::size_t kMinSamples = 10;
  constexpr TimeNs kStep = kNsPerSecond / 10;
  double least = std::numeric_limits<double>::infinity();
  std::size_t begin = 0;
  while (begin < samples.size()) {
    const TimeNs start = samples[begin].t_ns;
    std::size_t end = begin;
    Eigen::Vector3d gyro = Eigen::Vector3d::Zero();
    Eigen::Vector3d accel = Eigen::Vector3d::Zero();
    while (end < samples.size() && samples[end].t_ns - start < kNsPerSecond) {
      gyro += samples[end].gyro;
      accel += samples[end].accel;
      ++end;
    }
    const std::size_t count = end - begin;
    if (count >= kMinSamples) {
      gyro /= static_cast<double>(count);
      accel /= static_cast<double>(count);
      double squares = 0.0;
      for (std::size_t i = begin; i < end; ++i) squares += (samples[i].accel - accel).squaredNorm();
      const double spread = std::sqrt(squares / static_cast<double>(count));
      if (spread < least) {
        least = spread;
        imu.quiet_start_ns = start;
        imu.quiet_gyro = gyro;
        imu.quiet_accel_vehicle = R_vehicle_imu * accel;
        imu.quiet_accel_std = spread;
        imu.gravity = accel.norm();
      }
    }
    if (end == samples.size()) break;
    while (begin < samples.size() && samples[begin].t_ns - start < kStep) ++begin;
  }
}

}  // namespace

void describeSamples(const std::vector<ImuSample>& samples, const SO3& R_vehicle_imu,
                     ImuReport& report) {
  if (samples.empty()) return;
  const auto count = static_cast<double>(samples.size());
  for (const ImuSample& sample : samples) {
    report.gyro_mean += sample.gyro / count;
    report.accel_mean += sample.accel / count;
  }
  for (const ImuSample& sample : samples) {
    report.gyro_std += (sample.gyro - report.gyro_mean).cwiseAbs2() / count;
    report.accel_std += (sample.accel - report.accel_mean).cwiseAbs2() / count;
  }
  report.gyro_std = report.gyro_std.cwiseSqrt();
  report.accel_std = report.accel_std.cwiseSqrt();
  findQuietSecond(samples, R_vehicle_imu, report);
}

}  // namespace parkade
