// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "parkade/core/result.hpp"
#include "parkade/types/samples.hpp"

namespace parkade {

/// What is known before the first sample; counts are estimates and zero where unknown.
struct SensorSourceInfo {
  std::string name;  ///< for messages: a path, or sim:paper/test1
  TimeNs start_ns = 0;
  TimeNs end_ns = 0;
  int num_cameras = 0;
  int num_frame_sets = 0;
  bool has_wheel = false;
};

/// A stream of measurements in the order of time: a recorded sequence or the simulator. Nothing
/// downstream can tell which one it reads; truth never comes this way.
class SensorSource {
 public:
  virtual ~SensorSource() = default;
  [[nodiscard]] virtual const SensorSourceInfo& info() const = 0;
  /// The next event, nothing at the end, or an Error that ends the stream. Events come with
  /// non-decreasing timeOf(); an ImuSample comes before a FrameSet of the same stamp.
  virtual Result<std::optional<SensorEvent>> next() = 0;
};

}  // namespace parkade
