// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace parkade {

/// A caller's bug: a precondition that does not hold. what() names file, line, condition, values.
class CheckError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

namespace internal {
[[noreturn]] void throwCheckError(const char* file, int line, const char* condition,
                                  const std::string& message);
inline std::string checkMessage() {
  return {};
}
template <class... Args>
std::string checkMessage(fmt::format_string<Args...> format, Args&&... args) {
  return fmt::format(format, std::forward<Args>(args)...);
}
}  // namespace internal

}  // namespace parkade

/// PARKADE_CHECK(n > 0, "window has {} keyframes", n) throws CheckError where the condition fails.
#define PARKADE_CHECK(condition, ...)                                                       \
  do {                                                                                      \
    if (!(condition)) [[unlikely]] {                                                        \
      ::parkade::internal::throwCheckError(__FILE__, __LINE__, #condition,                  \
                                           ::parkade::internal::checkMessage(__VA_ARGS__)); \
    }                                                                                       \
  } while (false)
