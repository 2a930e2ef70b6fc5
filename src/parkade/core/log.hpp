// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <functional>
#include <string_view>

namespace parkade {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

/// Receives every message of the library. Called from any thread, one call at a time.
using LogSink = std::function<void(LogLevel, std::string_view)>;

/// Replaces the one sink; an empty one drops everything (the default: the library never prints).
void setLogSink(LogSink sink);

void logMessage(LogLevel level, std::string_view message);

template <class... Args>
void logDebug(fmt::format_string<Args...> format, Args&&... args) {
  logMessage(LogLevel::kDebug, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void logInfo(fmt::format_string<Args...> format, Args&&... args) {
  logMessage(LogLevel::kInfo, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void logWarning(fmt::format_string<Args...> format, Args&&... args) {
  logMessage(LogLevel::kWarning, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void logError(fmt::format_string<Args...> format, Args&&... args) {
  logMessage(LogLevel::kError, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace parkade
