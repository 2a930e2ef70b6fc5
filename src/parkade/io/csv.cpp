// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/csv.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "parkade/io/file.hpp"

namespace parkade {
namespace {

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

// std::from_chars takes no leading plus sign.
std::string_view withoutPlus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

std::optional<double> parseDouble(std::string_view text) {
  text = withoutPlus(text);
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || text.empty()) return std::nullopt;
  if (code == std::errc::result_out_of_range) {
    // Too small is zero or denormal, too large is infinite: strtod tells which.
    return std::strtod(std::string(text).c_str(), nullptr);
  }
  if (code != std::errc()) return std::nullopt;
  return value;
}

constexpr int kFractionDigits = 9;  // nanoseconds

}  // namespace

Result<CsvReader> CsvReader::open(const std::string& path, Separator separator) {
  Result<std::string> content = readFile(path);
  if (!content) return content.error();
  CsvReader reader;
  reader.path_ = path;
  reader.content_ = std::move(*content);
  reader.separator_ = separator;
  // A byte-order mark, as some spreadsheets write it.
  if (reader.content_.rfind("\xEF\xBB\xBF", 0) == 0) reader.content_.erase(0, 3);
  return reader;
}

void CsvReader::rewind() {
  position_ = 0;
  line_ = 0;
  fields_.clear();
}

bool CsvReader::nextRow() {
  fields_.clear();
  while (position_ < content_.size()) {
    const std::size_t end = std::min(content_.find('\n', position_), content_.size());
    std::string_view row{content_.data() + position_, end - position_};
    position_ = end + 1;
    ++line_;
    row = trimmed(row);
    if (row.empty() || row.front() == '#') continue;
    if (separator_ == Separator::kComma) {
      for (std::size_t comma = row.find(','); comma != std::string_view::npos;
           comma = row.find(',')) {
        fields_.push_back(trimmed(row.substr(0, comma)));
        row.remove_prefix(comma + 1);
      }
      fields_.push_back(trimmed(row));
    } else {
      while (!row.empty()) {
        const auto field_end = std::find_if(row.begin(), row.end(), isBlank);
        const auto length = static_cast<std::size_t>(field_end - row.begin());
        fields_.push_back(row.substr(0, length));
        row.remove_prefix(length);
        row = trimmed(row);
      }
    }
    return true;
  }
  return false;
}

void CsvReader::expectColumns(std::initializer_list<const char*> names) const {
  if (names.size() == count()) return;
  fail(fmt::format("expected {} columns ({}), found {}", names.size(),
                   fmt::join(names.begin(), names.end(), ", "), count()));
}

std::string_view CsvReader::text(std::size_t i) const {
  PARKADE_CHECK(i < count(), "field {} of a row of {}", i, count());
  return fields_[i];
}

TimeNs CsvReader::nanoseconds(std::size_t i, const char* name) const {
  const std::string_view field = withoutPlus(text(i));
  TimeNs value = 0;
  const auto [end, code] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (code != std::errc() || end != field.data() + field.size() || field.empty()) {
    fail(i, name, fmt::format("expected a whole number of nanoseconds, found '{}'", text(i)));
  }
  return value;
}

TimeNs CsvReader::seconds(std::size_t i, const char* name) const {
  const std::optional<TimeNs> value = parseSeconds(text(i));
  if (!value) fail(i, name, fmt::format("expected seconds, found '{}'", text(i)));
  return *value;
}

double CsvReader::number(std::size_t i, const char* name) const {
  const std::optional<double> value = parseDouble(text(i));
  if (!value) fail(i, name, fmt::format("expected a number, found '{}'", text(i)));
  if (!std::isfinite(*value)) {
    fail(i, name,
         fmt::format("{}, found '{}': remove the row or repair the file",
                     std::isnan(*value) ? "NaN is not a measurement" : "the number is not finite",
                     text(i)));
  }
  return *value;
}

double CsvReader::numberOrEmpty(std::size_t i, const char* name) const {
  return text(i).empty() ? std::numeric_limits<double>::quiet_NaN() : number(i, name);
}

void CsvReader::fail(std::size_t i, const char* name, const std::string& message) const {
  throw CsvError(fmt::format("{}:{}: column {} ({}): {}", path_, line_, i + 1, name, message));
}

void CsvReader::fail(const std::string& message) const {
  throw CsvError(fmt::format("{}:{}: {}", path_, line_, message));
}

std::optional<TimeNs> parseSeconds(std::string_view text) {
  text = withoutPlus(text);
  const bool negative = !text.empty() && text.front() == '-';
  if (negative) text.remove_prefix(1);

  // 1. The digits without their point, and the power of ten of the last one.
  int exponent = 0;
  const std::size_t e = text.find_first_of("eE");
  if (e != std::string_view::npos) {
    const std::string_view power = withoutPlus(text.substr(e + 1));
    const auto [end, code] = std::from_chars(power.data(), power.data() + power.size(), exponent);
    if (code != std::errc() || end != power.data() + power.size() || std::abs(exponent) > 1000) {
      return std::nullopt;
    }
    text = text.substr(0, e);
  }
  std::string digits;
  bool after_point = false;
  for (const char c : text) {
    if (c == '.' && !after_point) {
      after_point = true;
    } else if (c >= '0' && c <= '9') {
      digits += c;
      if (after_point) --exponent;
    } else {
      return std::nullopt;
    }
  }
  if (digits.empty()) return std::nullopt;

  // 2. Cut or fill the digits so that the last one counts nanoseconds; round by the first cut one.
  const int shift = exponent + kFractionDigits;
  bool round_up = false;
  if (shift < 0) {
    const auto cut = static_cast<std::size_t>(-shift);
    round_up = cut <= digits.size() && digits[digits.size() - cut] >= '5';
    digits.resize(cut < digits.size() ? digits.size() - cut : 0);
  } else {
    digits.append(static_cast<std::size_t>(shift), '0');
  }
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size()));
  if (digits.empty()) digits = "0";
  TimeNs value = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (code != std::errc() || value == std::numeric_limits<TimeNs>::max()) return std::nullopt;
  if (round_up) ++value;
  return negative ? -value : value;
}

std::string formatSeconds(TimeNs t_ns) {
  // Through unsigned: the smallest integer has no positive twin.
  const auto magnitude =
      t_ns < 0 ? 0 - static_cast<std::uint64_t>(t_ns) : static_cast<std::uint64_t>(t_ns);
  constexpr std::uint64_t kPerSecond = kNsPerSecond;
  return fmt::format("{}{}.{:09}", t_ns < 0 ? "-" : "", magnitude / kPerSecond,
                     magnitude % kPerSecond);
}

}  // namespace parkade
