// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "parkade/core/check.hpp"

namespace parkade {

/// An expected failure: what is wrong (file, line or key, offending value) and what to do about it.
struct Error {
  std::string message;
};

/// Either a value or an Error. For failures that a correct program must expect: files, formats,
/// no match. A caller's bug throws instead (check.hpp); a weak estimate is a field of the value.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : error_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool ok() const { return value_.has_value(); }
  explicit operator bool() const { return ok(); }

  /// The value; asking a failed result for it is a caller's bug and throws with the message.
  T& value() & {
    PARKADE_CHECK(ok(), "value() of a failed result: {}", error_.message);
    return *value_;
  }
  const T& value() const& {
    PARKADE_CHECK(ok(), "value() of a failed result: {}", error_.message);
    return *value_;
  }
  T&& value() && {
    PARKADE_CHECK(ok(), "value() of a failed result: {}", error_.message);
    return std::move(*value_);
  }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  [[nodiscard]] const Error& error() const { return error_; }

 private:
  std::optional<T> value_;
  Error error_;
};

/// Success, or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool ok() const { return !error_.has_value(); }
  explicit operator bool() const { return ok(); }
  [[nodiscard]] const Error& error() const {
    PARKADE_CHECK(!ok(), "error() of a successful result");
    return *error_;
  }

 private:
  std::optional<Error> error_;
};

using Status = Result<void>;

}  // namespace parkade
