// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/wheel_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace parkade {
namespace {

// The mean of those wheels that tell; NaN where none does.
double speedOf(const WheelSample& sample) {
  if (!std::isfinite(sample.rear_left_mps)) return sample.rear_right_mps;
  if (!std::isfinite(sample.rear_right_mps)) return sample.rear_left_mps;
  return 0.5 * (sample.rear_left_mps + sample.rear_right_mps);
}

// Changes of the speed over the same span of time, m/s.
struct SpeedChange {
  double by_wheels = 0.0;
  double by_accelerometer = 0.0;  // and what gravity adds where the car or the unit is tilted
};

std::vector<SpeedChange> speedChanges(const std::vector<WheelSample>& wheels,
                                      const std::vector<ImuSample>& imu, const SO3& R_vehicle_imu) {
  constexpr TimeNs kSpan = kNsPerSecond / 2;
  constexpr double kMaxStep = 0.1;  // s: longer ones are gaps
  std::vector<SpeedChange> changes;
  std::size_t i = 0;
  for (std::size_t begin = 0; begin < wheels.size();) {
    std::size_t end = begin;
    while (end + 1 < wheels.size() && wheels[end].t_ns - wheels[begin].t_ns < kSpan) ++end;
    const TimeNs until = wheels[end].t_ns;
    SpeedChange change;
    change.by_wheels = speedOf(wheels[end]) - speedOf(wheels[begin]);
    bool whole = end > begin && until - wheels[begin].t_ns < 2 * kSpan;
    while (i < imu.size() && imu[i].t_ns < wheels[begin].t_ns) ++i;
    const std::size_t first = i;
    for (; i + 1 < imu.size() && imu[i].t_ns < until; ++i) {
      const double step = toSeconds(imu[i + 1].t_ns - imu[i].t_ns);
      whole = whole && step < kMaxStep;
      change.by_accelerometer += step * (R_vehicle_imu * imu[i].accel).x();
    }
    constexpr std::size_t kMinSamples = 10;
    if (whole && i >= first + kMinSamples && std::isfinite(change.by_wheels)) {
      changes.push_back(change);
    }
    begin = end > begin ? end : begin + 1;
  }
  return changes;
}

}  // namespace

void describeWheels(const std::vector<WheelSample>& samples, WheelReport& report) {
  std::optional<TimeNs> previous;
  for (const WheelSample& sample : samples) {
    report.has_steering = report.has_steering || std::isfinite(sample.steering_rad);
    const double speed = std::abs(speedOf(sample));
    if (!std::isfinite(speed)) continue;
    report.max_speed_mps = std::max(report.max_speed_mps, speed);
    if (previous) report.distance_m += speed * toSeconds(sample.t_ns - *previous);
    previous = sample.t_ns;
  }
}

std::optional<Check> checkWheelUnit(const std::vector<WheelSample>& wheels,
                                    const std::vector<ImuSample>& imu, const SO3& R_vehicle_imu) {
  constexpr std::size_t kMinChanges = 10;
  constexpr double kMinSpread = 0.1;       // m/s, of the accelerometer's
  constexpr double kMinCorrelation = 0.7;  // by chance, ten have it once in fifty
  constexpr double kMaxRatio = 1.8;        // between metres and km/h, 3.6
  const std::vector<SpeedChange> changes = speedChanges(wheels, imu, R_vehicle_imu);
  if (changes.size() < kMinChanges) return std::nullopt;
  const auto count = static_cast<double>(changes.size());
  SpeedChange mean;
  for (const SpeedChange& change : changes) {
    mean.by_wheels += change.by_wheels / count;
    mean.by_accelerometer += change.by_accelerometer / count;
  }
  double ww = 0.0;
  double wa = 0.0;
  double aa = 0.0;
  for (const SpeedChange& change : changes) {
    const double w = change.by_wheels - mean.by_wheels;
    const double a = change.by_accelerometer - mean.by_accelerometer;
    ww += w * w / count;
    wa += w * a / count;
    aa += a * a / count;
  }
  if (std::sqrt(aa) < kMinSpread || std::abs(wa) < kMinCorrelation * std::sqrt(ww * aa)) {
    return std::nullopt;
  }
  const double ratio = std::copysign(std::sqrt(ww / aa), wa);
  const bool good = ratio > 1.0 / kMaxRatio && ratio < kMaxRatio;
  return Check{good ? CheckMark::kPass : CheckMark::kWarn, "wheel0 speeds",
               fmt::format("change {:.2f} times as fast as the accelerometer feels{}", ratio,
                           good          ? ""
                           : ratio < 0.0 ? ": forwards negative, or T_vehicle_imu turned round?"
                                         : ": km/h, or turns of the wheels?")};
}

}  // namespace parkade
