// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/core/time.hpp"

namespace parkade {

/// Thrown inside a reader by CsvReader; parseCsvFile turns it into an Error at the room's border.
class CsvError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Walks over the rows of a text file of numbers. Empty lines and lines that begin with '#' are
/// skipped, CRLF is accepted, blanks around a field are dropped. It is strict: every failure names
/// file, line, column and the value found, and no field is read that is only in part a number.
class CsvReader {
 public:
  enum class Separator { kComma, kBlank };  ///< kBlank: any run of blanks and tabs

  /// Fails where the file cannot be read.
  static Result<CsvReader> open(const std::string& path, Separator separator);

  /// Goes to the next row; false at the end of the file.
  bool nextRow();
  /// Back before the first row.
  void rewind();

  [[nodiscard]] std::size_t count() const { return fields_.size(); }  ///< fields of this row
  [[nodiscard]] int line() const { return line_; }                    ///< counts from 1
  [[nodiscard]] const std::string& path() const { return path_; }

  /// Throws where this row has another number of fields; says which columns were expected.
  void expectColumns(std::initializer_list<const char*> names) const;

  [[nodiscard]] std::string_view text(std::size_t i) const;  ///< i < count()
  /// Whole number of nanoseconds.
  [[nodiscard]] TimeNs nanoseconds(std::size_t i, const char* name) const;
  /// Seconds as a decimal number ("1311868164.363181", "1.5e3"), taken digit by digit: exact to the
  /// nanosecond, further digits are rounded.
  [[nodiscard]] TimeNs seconds(std::size_t i, const char* name) const;
  /// A finite number; NaN and infinity are refused.
  [[nodiscard]] double number(std::size_t i, const char* name) const;
  /// A finite number, or NaN for an empty field.
  [[nodiscard]] double numberOrEmpty(std::size_t i, const char* name) const;

  /// Throws CsvError "file:line: column i (name): message".
  [[noreturn]] void fail(std::size_t i, const char* name, const std::string& message) const;
  /// Throws CsvError "file:line: message".
  [[noreturn]] void fail(const std::string& message) const;

 private:
  std::string path_;
  std::string content_;
  Separator separator_ = Separator::kComma;
  std::size_t position_ = 0;
  int line_ = 0;
  std::vector<std::string_view> fields_;  // into content_, rebuilt by every nextRow()
};

/// Opens a file and hands it to the reader. A missing file and every CsvError come back as an
/// Error.
template <class T>
Result<T> parseCsvFile(const std::string& path, CsvReader::Separator separator,
                       const std::function<T(CsvReader&)>& reader) {
  Result<CsvReader> csv = CsvReader::open(path, separator);
  if (!csv) return csv.error();
  try {
    return reader(*csv);
  } catch (const CsvError& error) {
    return Error{error.what()};
  }
}

/// The decimal number as nanoseconds if it were seconds, exact; nothing where it is no number or
/// too large for the range (about 292 years).
std::optional<TimeNs> parseSeconds(std::string_view text);

/// Seconds with nine decimals, from the integer: "1311868164.363181000".
std::string formatSeconds(TimeNs t_ns);

}  // namespace parkade
