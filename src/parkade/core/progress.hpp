// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdio>
#include <functional>
#include <string>

namespace parkade {

/// What long work reports to: the share done, 0 to 1. Empty means nobody watches.
using ProgressCallback = std::function<void(double fraction)>;

/// Shows progress with the remaining time: one line rewritten in place on a terminal, and plain
/// lines (at most one every 10 s or 10 %) elsewhere.
class ProgressPrinter {
 public:
  explicit ProgressPrinter(std::string label, std::FILE* stream = stderr);
  ~ProgressPrinter();
  ProgressPrinter(const ProgressPrinter&) = delete;
  ProgressPrinter& operator=(const ProgressPrinter&) = delete;

  void update(double fraction);
  /// Ends the line; called by the destructor as well.
  void finish();
  ProgressCallback callback() {
    return [this](double fraction) { update(fraction); };
  }

 private:
  void showLine(const std::string& text, const char* terminal_end);

  using Clock = std::chrono::steady_clock;
  std::string label_;
  std::FILE* stream_;
  bool terminal_;
  bool finished_ = false;
  bool shown_ = false;
  double last_fraction_ = 0.0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_time_ = start_;
};

}  // namespace parkade
