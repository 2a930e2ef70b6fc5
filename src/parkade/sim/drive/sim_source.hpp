// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "parkade/core/result.hpp"
#include "parkade/sim/drive/simulation.hpp"
#include "parkade/types/sensor_source.hpp"

namespace parkade::sim {

/// Draws the frame set of an index, from 0; called in ascending order by each thread that draws.
using FrameFunction = std::function<Result<FrameSet>(int index)>;

/// Enough that a reader seldom waits, few enough to be kept in memory.
constexpr int kFrameSetsAhead = 3;

/// A drive as a stream of measurements: inertial samples, wheels, pictures, in the order of time.
/// Pictures are drawn ahead in the background, a few at a time. The same simulation gives the same
/// bytes for any number of threads.
class SimSource : public SensorSource {
 public:
  /// Without a frame function no pictures come. rig: the cameras that it draws, as the reader is
  /// told of them. `ahead`: frame sets that wait drawn, at most (not less than threads). `threads`
  /// draw, a frame set each: more than one call the function at the same time.
  SimSource(std::shared_ptr<const Simulation> simulation, Rig rig, FrameFunction draw,
            int ahead = kFrameSetsAhead, int threads = 1);
  ~SimSource() override;
  SimSource(const SimSource&) = delete;
  SimSource& operator=(const SimSource&) = delete;

  [[nodiscard]] const SensorSourceInfo& info() const override { return info_; }
  Result<std::optional<SensorEvent>> next() override;
  [[nodiscard]] const Rig& rig() const { return rig_; }
  [[nodiscard]] const Simulation& simulation() const { return *simulation_; }

 private:
  class Ahead;  // the background threads and their queue

  std::shared_ptr<const Simulation> simulation_;
  Rig rig_;
  SensorSourceInfo info_;
  std::unique_ptr<Ahead> ahead_;
  std::size_t next_imu_ = 0;
  std::size_t next_wheel_ = 0;
  std::size_t next_frame_ = 0;
};

}  // namespace parkade::sim
