// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/interruption.hpp"

#include <fmt/core.h>

#include <csignal>
#include <cstring>
#include <utility>

namespace parkade::cli {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM};

volatile std::sig_atomic_t noted = 0;

void note(int signal) {
  noted = signal;
}

class InterruptibleSource : public SensorSource {
 public:
  explicit InterruptibleSource(std::unique_ptr<SensorSource> source) : source_(std::move(source)) {}

  [[nodiscard]] const SensorSourceInfo& info() const override { return source_->info(); }
  Result<std::optional<SensorEvent>> next() override {
    if (const int signal = Interruption::signal(); signal != 0) {
      return Error{fmt::format("{}: stopped by a signal ({})", info().name, strsignal(signal))};
    }
    return source_->next();
  }

 private:
  std::unique_ptr<SensorSource> source_;
};

}  // namespace

HandledSignals::HandledSignals(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // the next one ends the program
  sigemptyset(&action.sa_mask);
  for (const int signal : kSignals) sigaction(signal, &action, nullptr);
}

HandledSignals::~HandledSignals() {
  for (const int signal : kSignals) std::signal(signal, SIG_DFL);
}

Interruption::Interruption() : handled_(note) {}

int Interruption::signal() {
  return noted;
}

std::unique_ptr<SensorSource> interruptible(std::unique_ptr<SensorSource> source) {
  return std::make_unique<InterruptibleSource>(std::move(source));
}

}  // namespace parkade::cli
