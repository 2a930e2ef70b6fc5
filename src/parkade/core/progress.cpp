// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/core/progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace parkade {
namespace {

std::string remainingTime(double seconds) {
  if (seconds < 90.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400.0) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

}  // namespace

ProgressPrinter::ProgressPrinter(std::string label, std::FILE* stream)
    : label_(std::move(label)), stream_(stream), terminal_(isatty(fileno(stream)) != 0) {}

ProgressPrinter::~ProgressPrinter() {
  finish();
}

void ProgressPrinter::update(double fraction) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  const Clock::time_point now = Clock::now();
  const double since_last = std::chrono::duration<double>(now - last_time_).count();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double wanted_pause = terminal_ ? 0.1 : 10.0;
  const bool big_step = !terminal_ && fraction - last_fraction_ >= 0.1 && since_last >= 1.0;
  if (finished_ || (since_last < wanted_pause && !big_step)) return;
  last_time_ = now;
  last_fraction_ = fraction;
  shown_ = true;
  const std::string left =
      fraction > 0.005 ? ", " + remainingTime(elapsed * (1.0 - fraction) / fraction) + " left" : "";
  const std::string text = fmt::format("{} {:3.0f} %{}", label_, 100.0 * fraction, left);
  showLine(text, "");
}

void ProgressPrinter::showLine(const std::string& text, const char* terminal_end) {
  const std::string line = terminal_ ? fmt::format("\r{:<78}{}", text, terminal_end) : text + "\n";
  // A full disk behind a log must not end the work that it tells of.
  if (std::fputs(line.c_str(), stream_) >= 0) std::fflush(stream_);
}

void ProgressPrinter::finish() {
  if (finished_) return;
  finished_ = true;
  if (!shown_) return;
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const std::string text = fmt::format("{} done in {:.1f} s", label_, elapsed);
  showLine(text, "\n");
}

}  // namespace parkade
