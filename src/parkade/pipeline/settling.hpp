// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>

#include "parkade/core/time.hpp"

namespace parkade {

/// Tells when the odometry has settled after key points were missing for long: until it has found
/// its speed anew it may correct all of the way since by up to what dead reckoning was off, and
/// what a map took in before that would stand apart from what it takes in after.
class Settling {
 public:
  /// At each frame set, in their order; tracked: key points are in view.
  bool settled(TimeNs t_ns, bool tracked) {
    constexpr TimeNs kLong = 2 * kNsPerSecond;
    constexpr TimeNs kSettling = 3 * kNsPerSecond / 2;
    if (tracked) {
      if (last_tracked_ns_ && t_ns - *last_tracked_ns_ > kLong) from_ns_ = t_ns + kSettling;
      last_tracked_ns_ = t_ns;
    }
    return t_ns >= from_ns_;
  }

 private:
  std::optional<TimeNs> last_tracked_ns_;
  TimeNs from_ns_ = std::numeric_limits<TimeNs>::min();
};

}  // namespace parkade
