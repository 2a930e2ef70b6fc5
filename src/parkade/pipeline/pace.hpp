// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "parkade/core/time.hpp"
#include "parkade/pipeline/stage_clock.hpp"

namespace parkade {

/// Hands a recording out no faster than `times` the pace of its stamps, as the car's sensors would
/// at 1; at 0 as fast as it is read.
class Pace {
 public:
  using Clock = BusyTime::Clock;

  explicit Pace(double times) : times_(times) {}

  /// Sleeps until what bears this stamp is due, counted from the first stamp asked for. Returns
  /// when it was due, which may be past for who lags behind; at no pace set, now.
  Clock::time_point awaitDue(TimeNs t_ns);

 private:
  struct Start {
    Clock::time_point at;
    TimeNs t_ns = 0;
  };

  double times_ = 0.0;
  std::optional<Start> start_;
};

}  // namespace parkade
