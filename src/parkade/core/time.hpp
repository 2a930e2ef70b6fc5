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

/// Nearest nanosecond of a duration in seconds. More than 100 years either way (no time is that
/// long; an endless one stands for none) become these; NaN becomes 0.
constexpr TimeNs fromSeconds(double seconds) {
  constexpr double kLongest = 3.2e18;
  const double ns = seconds * 1e9;
  if (!(ns > -kLongest)) return ns < 0.0 ? -static_cast<TimeNs>(kLongest) : 0;
  if (ns > kLongest) return static_cast<TimeNs>(kLongest);
  return static_cast<TimeNs>(ns < 0.0 ? ns - 0.5 : ns + 0.5);
}

}  // namespace parkade
