// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/imu/reading_buffer.hpp"

#include <algorithm>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/core/median.hpp"

namespace parkade {
namespace {

constexpr double kMaxForce = 160.0;                    // m/s^2
constexpr double kMaxRate = 35.0;                      // rad/s
constexpr double kSpikeForce = 20.0;                   // m/s^2, off the median around
constexpr double kSpikeRate = 2.0;                     // rad/s
constexpr TimeNs kSpikeSurroundings = 100 * kNsPerMs;  // on either side
constexpr TimeNs kLongestSpike = 50 * kNsPerMs;
constexpr std::size_t kMinSurroundings = 5;

constexpr double kIsolatedForce = 20.0;        // m/s^2, off both neighbours
constexpr double kIsolatedRate = 0.5;          // rad/s
constexpr double kUnusual = 10.0;              // times what is usual
constexpr double kMostApart = 0.5;             // of the neighbours, of what stands apart
constexpr double kLearningShare = 0.01;        // of each reading
constexpr TimeNs kNeighbours = 50 * kNsPerMs;  // from one to the other

// Whether a value stands apart from those before and after it. Learns what is usual.
bool standsApart(const Eigen::Vector3d& before, const Eigen::Vector3d& value,
                 const Eigen::Vector3d& after, double least, double& usual) {
  const double off = (value - 0.5 * (before + after)).norm();
  const double limit = std::max(least, kUnusual * usual);
  usual += kLearningShare * (std::min(off, limit) - usual);
  return off > limit && (after - before).norm() < kMostApart * off;
}

}  // namespace

bool ReadingBuffer::add(const ImuReading& reading) {
  if (!readings_.empty() && reading.t_ns <= readings_.back().t_ns) return false;
  // Not so for what is not finite, either.
  const bool possible = reading.gyro.norm() <= kMaxRate && reading.accel.norm() <= kMaxForce;
  if (!possible) return false;
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
    // What is held beyond the last reading is the less worth the longer it is held.
    const TimeNs judged = readings[i + 1].t_ns > lastTime() ? readings[i + 1].t_ns : middle;
    sum.integrate(readings[i], readings[i + 1], spacingAt(judged) > gap_ns ? 0 : gap_ns);
  }
  return sum;
}

std::optional<TimeNs> ReadingBuffer::dropIsolated() {
  const std::size_t count = readings_.size();
  if (count < 3) return std::nullopt;
  const ImuReading& before = readings_[count - 3];
  const ImuReading& reading = readings_[count - 2];
  const ImuReading& after = readings_[count - 1];
  if (after.t_ns - before.t_ns > kNeighbours) return std::nullopt;
  const bool rate = standsApart(before.gyro, reading.gyro, after.gyro, kIsolatedRate, usual_rate_);
  const bool force =
      standsApart(before.accel, reading.accel, after.accel, kIsolatedForce, usual_force_);
  if (!rate && !force) return std::nullopt;
  const TimeNs t_ns = reading.t_ns;
  readings_.erase(readings_.end() - 2);
  return t_ns;
}

std::vector<char> ReadingBuffer::unusual(std::size_t from, std::size_t to) const {
  Eigen::Vector3d usual_gyro = Eigen::Vector3d::Zero();
  Eigen::Vector3d usual_accel = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> gyro;
    std::vector<double> accel;
    for (std::size_t i = from; i < to; ++i) {
      gyro.push_back(readings_[i].gyro(axis));
      accel.push_back(readings_[i].accel(axis));
    }
    usual_gyro(axis) = median(std::move(gyro));
    usual_accel(axis) = median(std::move(accel));
  }
  std::vector<char> result;
  for (std::size_t i = from; i < to; ++i) {
    result.push_back((readings_[i].gyro - usual_gyro).norm() > kSpikeRate ||
                     (readings_[i].accel - usual_accel).norm() > kSpikeForce);
  }
  return result;
}

int ReadingBuffer::dropSpikes(TimeNs begin_ns, TimeNs end_ns) {
  const std::size_t after = indexAfter(begin_ns);
  const std::size_t first = after > 0 ? after - 1 : 0;
  const std::size_t last = std::min(indexAfter(end_ns) + 1, readings_.size());
  const std::size_t from = std::min(indexAfter(begin_ns - kSpikeSurroundings), first);
  const std::size_t to = std::max(indexAfter(end_ns + kSpikeSurroundings), last);
  if (to - from < kMinSurroundings) return 0;
  const std::vector<char> far = unusual(from, to);
  int dropped = 0;
  // From the back, so that what lies before stays where it is.
  for (std::size_t end = to; end > from;) {
    std::size_t begin = end - 1;
    if (far[begin - from] == 0) {
      end = begin;
      continue;
    }
    while (begin > from && far[begin - 1 - from] != 0) --begin;
    // What goes on at either end may be a step that stays.
    if (begin > from && end < to && begin < last && end > first &&
        readings_[end].t_ns - readings_[begin - 1].t_ns <= kLongestSpike) {
      readings_.erase(readings_.begin() + static_cast<std::ptrdiff_t>(begin),
                      readings_.begin() + static_cast<std::ptrdiff_t>(end));
      dropped += static_cast<int>(end - begin);
    }
    end = begin;
  }
  return dropped;
}

void ReadingBuffer::dropBefore(TimeNs t_ns) {
  // The last reading at or before t_ns is still needed to interpolate there.
  while (readings_.size() > 1 && readings_[1].t_ns <= t_ns) readings_.pop_front();
}

}  // namespace parkade
