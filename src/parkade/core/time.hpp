// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace parkade {

/// Time is nanoseconds since an epoch of the recording's choice; names end in _ns.
using TimeNs = std::int64_t;

inline constexpr TimeNs kNsPerSecond = 1'000'000'000;
inline constexpr TimeNs kNsPerMs = 1'000'000;

/// Seconds of a duration (or of a stamp, where double precision does not matter).
constexpr double toSeconds(TimeNs t_ns) {
  return static_cast<double>(t_ns) * 1e-9;
}

/// Nearest nanosecond of a duration in seconds.
constexpr TimeNs fromSeconds(double seconds) {
  const double ns = seconds * 1e9;
  return static_cast<TimeNs>(ns < 0.0 ? ns - 0.5 : ns + 0.5);
}

}  // namespace parkade
