// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/pace.hpp"

#include <chrono>
#include <thread>

namespace parkade {

Pace::Clock::time_point Pace::awaitDue(TimeNs t_ns) {
  const Clock::time_point now = Clock::now();
  if (!(times_ > 0.0)) return now;
  if (!start_) start_ = Start{now, t_ns};
  const std::chrono::duration<double> after(toSeconds(t_ns - start_->t_ns) / times_);
  const Clock::time_point due = start_->at + std::chrono::duration_cast<Clock::duration>(after);
  std::this_thread::sleep_until(due);
  return due;
}

}  // namespace parkade
