// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/geometry/se3.hpp"
#include "parkade/pipeline/stage_clock.hpp"
#include "parkade/types/motion_prior.hpp"
#include "parkade/types/sensor_source.hpp"

namespace parkade {

/// A frame set with the readings that came since the one before, and the first inertial one after
/// it, so that these can be interpolated at its instant.
struct FramePacket {
  std::vector<ImuSample> imu;
  std::vector<WheelSample> wheel;
  FrameSet frames;
  BusyTime::Clock::time_point arrived;  ///< when the frame set was there
  double reading_ms = 0.0;              ///< waiting for the source since the packet before
};

/// Reads a source and parts what it gives into packets.
class FramePackets {
 public:
  /// arrive(t_ns): called when a frame set has come; gives when it did. live: frame sets that came
  /// long before they are asked for are passed over, as a car that lags behind must; their
  /// readings go to the packet after them.
  FramePackets(SensorSource& source, std::function<BusyTime::Clock::time_point(TimeNs)> arrive,
               bool live)
      : source_(source), arrive_(std::move(arrive)), live_(live) {}

  /// The next packet; nothing at the source's end. A source that fails first gives the frame set
  /// that waits, then its error.
  Result<std::optional<FramePacket>> next();
  [[nodiscard]] double readingSeconds() const { return 1e-3 * total_ms_; }
  /// Frame sets that a live run took no time for.
  [[nodiscard]] int passedOver() const { return passed_over_; }

 private:
  Result<std::optional<FramePacket>> read();
  [[nodiscard]] bool isLate(const FramePacket& packet) const;
  void begin(FrameSet frames);
  std::optional<FramePacket> release();  // the one that waits, where there is one
  SensorSource& source_;
  std::function<BusyTime::Clock::time_point(TimeNs)> arrive_;
  bool live_;
  int passed_over_ = 0;
  std::optional<FramePacket> waiting_;  // for its next inertial reading
  FramePacket gathering_;
  std::optional<FrameSet> next_frames_;  // came while another one waited
  std::optional<Error> failed_;
  double reading_ms_ = 0.0;
  double total_ms_ = 0.0;
};

/// The turn of the vehicle between two instants by the gyroscope alone, its bias unknown: what can
/// be said before an estimator has started. Not valid where readings are missing.
MotionPrior turnByGyroscope(const std::vector<ImuSample>& readings, const SE3& T_vehicle_imu,
                            TimeNs begin_ns, TimeNs end_ns);

}  // namespace parkade
