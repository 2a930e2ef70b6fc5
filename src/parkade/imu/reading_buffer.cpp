// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/imu/reading_buffer.hpp"

#include <algorithm>

#include "parkade/core/check.hpp"

namespace parkade {

bool ReadingBuffer::add(const ImuReading& reading) {
  if (!readings_.empty() && reading.t_ns <= readings_.back().t_ns) return false;
  if (!reading.gyro.allFinite() || !reading.accel.allFinite()) return false;
  readings_.push_back(reading);
  return true;
}

std::size_t ReadingBuffer::indexAfter(TimeNs t_ns) const {
  const auto it =
      std::upper_bound(readings_.begin(), readings_.end(), t_ns,
                       [](TimeNs t, const ImuReading& reading) { return t < reading.t_ns; });
  return static_cast<std::size_t>(it - readings_.begin());
}

ImuReading ReadingBuffer::at(TimeNs t_ns) const {
  PARKADE_CHECK(!readings_.empty(), "no IMU reading at {}", t_ns);
  const std::size_t after = indexAfter(t_ns);
  ImuReading reading;
  if (after == 0) {
    reading = readings_.front();
  } else if (after == readings_.size()) {
    reading = readings_.back();
  } else {
    const ImuReading& a = readings_[after - 1];
    const ImuReading& b = readings_[after];
    const double ratio = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
    reading.gyro = a.gyro + ratio * (b.gyro - a.gyro);
    reading.accel = a.accel + ratio * (b.accel - a.accel);
  }
  reading.t_ns = t_ns;
  return reading;
}

std::vector<ImuReading> ReadingBuffer::between(TimeNs begin_ns, TimeNs end_ns) const {
  PARKADE_CHECK(begin_ns <= end_ns, "IMU readings between {} and {}", begin_ns, end_ns);
  std::vector<ImuReading> result;
  if (readings_.empty()) return result;
  const std::size_t first = indexAfter(begin_ns);
  result.push_back(at(begin_ns));
  for (std::size_t i = first; i < readings_.size() && readings_[i].t_ns < end_ns; ++i) {
    result.push_back(readings_[i]);
  }
  if (end_ns > begin_ns) result.push_back(at(end_ns));
  return result;
}

TimeNs ReadingBuffer::spacingAt(TimeNs t_ns) const {
  PARKADE_CHECK(!readings_.empty(), "no IMU reading at {}", t_ns);
  const std::size_t after = indexAfter(t_ns);
  if (after == 0) return readings_.front().t_ns - t_ns;
  if (after == readings_.size()) return t_ns - readings_.back().t_ns;
  return readings_[after].t_ns - readings_[after - 1].t_ns;
}

Preintegration ReadingBuffer::sumBetween(TimeNs begin_ns, TimeNs end_ns, const ImuNoise& noise,
                                         const ImuBias& bias, TimeNs gap_ns) const {
  Preintegration sum(noise, bias);
  const std::vector<ImuReading> readings = between(begin_ns, end_ns);
  for (std::size_t i = 0; i + 1 < readings.size(); ++i) {
    const TimeNs middle = readings[i].t_ns + (readings[i + 1].t_ns - readings[i].t_ns) / 2;
    sum.integrate(readings[i], readings[i + 1], spacingAt(middle) > gap_ns ? 0 : gap_ns);
  }
  return sum;
}

void ReadingBuffer::dropBefore(TimeNs t_ns) {
  // The last reading at or before t_ns is still needed to interpolate there.
  while (readings_.size() > 1 && readings_[1].t_ns <= t_ns) readings_.pop_front();
}

}  // namespace parkade
