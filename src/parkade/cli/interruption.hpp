// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "parkade/types/sensor_source.hpp"

namespace parkade::cli {

/// While one lives, the first SIGINT and the first SIGTERM go to a handler; a second one ends the
/// program.
class HandledSignals {
 public:
  explicit HandledSignals(void (*handler)(int));
  ~HandledSignals();
  HandledSignals(const HandledSignals&) = delete;
  HandledSignals& operator=(const HandledSignals&) = delete;
};

/// While one lives, the first SIGINT or SIGTERM is noted instead of ending the program.
class Interruption {
 public:
  Interruption();

  /// The signal that came; 0: none.
  [[nodiscard]] static int signal();

 private:
  HandledSignals handled_;
};

/// A source that ends with an Error once an Interruption has noted a signal: what was done until
/// then is kept.
std::unique_ptr<SensorSource> interruptible(std::unique_ptr<SensorSource> source);

}  // namespace parkade::cli
