// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "parkade/types/sensor_source.hpp"

namespace parkade::cli {

/// While one lives, the first SIGINT or SIGTERM is noted instead of ending the program; a second
/// one ends it.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// The signal that came; 0: none.
  [[nodiscard]] static int signal();
};

/// A source that ends with an Error once an Interruption has noted a signal: what was done until
/// then is kept.
std::unique_ptr<SensorSource> interruptible(std::unique_ptr<SensorSource> source);

}  // namespace parkade::cli
