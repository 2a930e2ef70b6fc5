// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/frame_packets.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace parkade {

void FramePackets::begin(FrameSet frames) {
  waiting_ = std::exchange(gathering_, FramePacket{});
  waiting_->frames = std::move(frames);
  waiting_->arrived = arrive_(waiting_->frames.t_ns);
}

std::optional<FramePacket> FramePackets::release() {
  if (waiting_) waiting_->reading_ms = std::exchange(reading_ms_, 0.0);
  return std::exchange(waiting_, std::nullopt);
}

bool FramePackets::isLate(const FramePacket& packet) const {
  constexpr double kLate = 200.0;  // ms
  return live_ && millisecondsBetween(packet.arrived, BusyTime::Clock::now()) > kLate;
}

Result<std::optional<FramePacket>> FramePackets::next() {
  FramePacket passed_over;
  while (true) {
    Result<std::optional<FramePacket>> packet = read();
    if (!packet || !packet->has_value()) return packet;
    FramePacket& found = **packet;
    const auto append = [](auto& readings, auto& later) {
      readings.insert(readings.end(), later.begin(), later.end());
      later = std::move(readings);
    };
    append(passed_over.imu, found.imu);
    append(passed_over.wheel, found.wheel);
    found.reading_ms += passed_over.reading_ms;
    if (!isLate(found)) return packet;
    ++passed_over_;
    passed_over = std::move(found);
  }
}

Result<std::optional<FramePacket>> FramePackets::read() {
  using Clock = BusyTime::Clock;
  if (next_frames_) begin(*std::exchange(next_frames_, std::nullopt));
  while (!failed_) {
    const Clock::time_point asked = Clock::now();
    Result<std::optional<SensorEvent>> event = source_.next();
    const double waited = millisecondsBetween(asked, Clock::now());
    reading_ms_ += waited;
    total_ms_ += waited;
    if (!event) {
      failed_ = event.error();
      break;
    }
    if (!event->has_value()) {
      return release();
    }
    if (const auto* imu = std::get_if<ImuSample>(&**event)) {
      (waiting_ ? waiting_->imu : gathering_.imu).push_back(*imu);
      if (waiting_ && imu->t_ns >= waiting_->frames.t_ns) {
        return release();
      }
    } else if (const auto* wheel = std::get_if<WheelSample>(&**event)) {
      // Between a frame set and the reading that it waits for, only what is not later belongs to
      // it.
      const bool belongs = waiting_ && wheel->t_ns <= waiting_->frames.t_ns;
      (belongs ? waiting_->wheel : gathering_.wheel).push_back(*wheel);
    } else {
      auto frames = std::get<FrameSet>(std::move(**event));
      if (!waiting_) {
        begin(std::move(frames));
      } else {
        // The inertial unit is silent: the frame set before goes on without the reading after it.
        next_frames_ = std::move(frames);
        return release();
      }
    }
  }
  if (waiting_) return release();
  return *failed_;
}

MotionPrior turnByGyroscope(const std::vector<ImuSample>& readings, const SE3& T_vehicle_imu,
                            TimeNs begin_ns, TimeNs end_ns) {
  MotionPrior prior;
  prior.previous_t_ns = begin_ns;
  if (readings.size() < 2) return prior;
  SO3 R_begin_now;
  TimeNs covered = 0;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    const TimeNs from = std::max(readings[i - 1].t_ns, begin_ns);
    const TimeNs to = std::min(readings[i].t_ns, end_ns);
    if (to <= from) continue;
    const Eigen::Vector3d rate = 0.5 * (readings[i - 1].gyro + readings[i].gyro);
    R_begin_now = R_begin_now * SO3::exp(rate * toSeconds(to - from));
    covered += to - from;
  }
  // A gap in the readings leaves the turn unknown.
  prior.valid = 10 * covered > 9 * (end_ns - begin_ns);
  const SO3& R_vehicle_imu = T_vehicle_imu.rotation();
  prior.T_previous_current.rotation() = R_vehicle_imu * R_begin_now * R_vehicle_imu.inverse();
  return prior;
}

}  // namespace parkade
