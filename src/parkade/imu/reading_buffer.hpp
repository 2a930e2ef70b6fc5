// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "parkade/imu/imu_types.hpp"
#include "parkade/imu/preintegration.hpp"

namespace parkade {

/// Recent IMU readings in the order of time, cut at any instant.
class ReadingBuffer {
 public:
  /// Appends a reading. False, and nothing is kept, where it is not newer than the last one, not
  /// finite, or beyond what a vehicle can do (160 m/s^2, 35 rad/s).
  bool add(const ImuReading& reading);

  /// Readings that cover [begin_ns, end_ns], with the ends interpolated between their neighbours.
  /// An end before the first or after the last reading holds that one. Empty where no reading is
  /// known.
  [[nodiscard]] std::vector<ImuReading> between(TimeNs begin_ns, TimeNs end_ns) const;
  /// The same, summed up; where the readings themselves lie further apart than gap_ns, whatever was
  /// interpolated between them counts as a gap. So does what lies further beyond the last reading.
  [[nodiscard]] Preintegration sumBetween(TimeNs begin_ns, TimeNs end_ns, const ImuNoise& noise,
                                          const ImuBias& bias, TimeNs gap_ns) const;
  /// Time between the readings around an instant, or to the nearest one beyond the ends.
  [[nodiscard]] TimeNs spacingAt(TimeNs t_ns) const;
  /// The reading at an instant, interpolated or held.
  [[nodiscard]] ImuReading at(TimeNs t_ns) const;

  /// Forgets the reading before the newest one where it stands apart from both its neighbours and
  /// these agree: a broken transfer, for no vehicle moves so within one reading. What is usual
  /// between neighbours, engine and road included, is learned. Call it after each add(); returns
  /// the time of what was forgotten.
  std::optional<TimeNs> dropIsolated();

  /// Forgets broken readings, single or a few, among those that cover two instants: they lie far
  /// from the median of those around, and the readings before and after them do not. Returns how
  /// many.
  int dropSpikes(TimeNs begin_ns, TimeNs end_ns);

  /// Forgets what is not needed to cover instants from t_ns on.
  void dropBefore(TimeNs t_ns);
  [[nodiscard]] bool empty() const { return readings_.empty(); }
  [[nodiscard]] std::size_t size() const { return readings_.size(); }
  [[nodiscard]] TimeNs firstTime() const { return readings_.front().t_ns; }
  [[nodiscard]] TimeNs lastTime() const { return readings_.back().t_ns; }
  [[nodiscard]] const std::deque<ImuReading>& readings() const { return readings_; }

 private:
  /// Index of the first reading later than t_ns.
  [[nodiscard]] std::size_t indexAfter(TimeNs t_ns) const;
  /// Whether each of some readings lies far from their median.
  [[nodiscard]] std::vector<char> unusual(std::size_t from, std::size_t to) const;
  std::deque<ImuReading> readings_;
  double usual_rate_ = 0.0;   ///< rad/s, by which readings miss the mean of their neighbours
  double usual_force_ = 0.0;  ///< m/s^2
};

}  // namespace parkade
