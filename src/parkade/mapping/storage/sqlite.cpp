// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/storage/sqlite.hpp"

#include <fmt/core.h>

#include <cmath>

namespace parkade::sqlite {
namespace {

const char* typeName(int type) {
  switch (type) {
    case SQLITE_INTEGER:
      return "a whole number";
    case SQLITE_FLOAT:
      return "a number";
    case SQLITE_TEXT:
      return "a text";
    case SQLITE_BLOB:
      return "a blob";
    default:
      return "empty";
  }
}

}  // namespace

std::string quoted(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string plain = "'";
  for (const char c : text.substr(0, kMost)) plain += c >= ' ' && c <= '~' ? c : '?';
  return plain + (text.size() > kMost ? "...'" : "'");
}

Database::Database(const std::string& path, Mode mode) : path_(path) {
  sqlite3* handle = nullptr;
  const int flags =
      SQLITE_OPEN_READWRITE | (mode == Mode::kReadWriteCreate ? SQLITE_OPEN_CREATE : 0);
  // SQLite falls back to read-only by itself where the file's permissions ask for it.
  const int code = sqlite3_open_v2(path.c_str(), &handle, flags, nullptr);
  handle_.reset(handle);
  if (code != SQLITE_OK) fail("cannot be opened");
  sqlite3_extended_result_codes(handle, 1);
  sqlite3_busy_timeout(handle, 2000);
  // A file is data: nothing in it may call functions, and its pages are checked as they are read.
  execute("PRAGMA trusted_schema = OFF");
  execute("PRAGMA cell_size_check = ON");
}

void Database::fail(const std::string& doing) const {
  const char* reason = handle_ ? sqlite3_errmsg(handle_.get()) : "out of memory";
  throw SqliteError(fmt::format("{}: {}: {}", path_, doing, reason));
}

void Database::execute(const std::string& sql) {
  const int code = sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr) & 0xff;
  if (code == SQLITE_FULL || code == SQLITE_READONLY || code == SQLITE_IOERR) {
    fail("cannot be written");
  }
  if (code != SQLITE_OK) fail("not a readable map (" + sql.substr(0, 40) + ")");
}

Statement::Statement(const Database& database, const std::string& sql) : database_(database) {
  sqlite3_stmt* handle = nullptr;
  if (sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &handle, nullptr) != SQLITE_OK) {
    database.fail("not a readable map");
  }
  handle_.reset(handle);
}

void Statement::check(int code, const char* doing) const {
  if (code != SQLITE_OK) database_.fail(doing);
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  check(sqlite3_bind_int64(handle_.get(), parameter, value), "cannot be written");
  return *this;
}

Statement& Statement::bind(int parameter, double value) {
  check(sqlite3_bind_double(handle_.get(), parameter, value), "cannot be written");
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view text) {
  check(sqlite3_bind_text(handle_.get(), parameter, text.data(), static_cast<int>(text.size()),
                          SQLITE_TRANSIENT),
        "cannot be written");
  return *this;
}

Statement& Statement::bind(int parameter, std::span<const std::uint8_t> blob) {
  check(sqlite3_bind_blob(handle_.get(), parameter, blob.data(), static_cast<int>(blob.size()),
                          SQLITE_TRANSIENT),
        "cannot be written");
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(handle_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) database_.fail("cannot be read or written");
  return false;
}

void Statement::run() {
  while (step()) {
  }
  check(sqlite3_reset(handle_.get()), "cannot be written");
}

std::string Statement::columnName(int column) const {
  // Null where a damaged schema has fewer columns than were asked for.
  const char* name = sqlite3_column_name(handle_.get(), column);
  if (name == nullptr) throw SqliteError(fmt::format("column number {} is missing", column));
  return name;
}

void Statement::expectType(int column, int type) const {
  const int found = sqlite3_column_type(handle_.get(), column);
  const bool number_as_whole = type == SQLITE_FLOAT && found == SQLITE_INTEGER;
  if (found != type && !number_as_whole) {
    throw SqliteError(fmt::format("{} is {} ({}), expected {}", columnName(column), typeName(found),
                                  shown(column), typeName(type)));
  }
}

std::int64_t Statement::integer(int column) const {
  expectType(column, SQLITE_INTEGER);
  return sqlite3_column_int64(handle_.get(), column);
}

double Statement::real(int column) const {
  expectType(column, SQLITE_FLOAT);
  const double value = sqlite3_column_double(handle_.get(), column);
  if (!std::isfinite(value)) {
    throw SqliteError(fmt::format("{} is {}, expected a finite number", columnName(column), value));
  }
  return value;
}

std::string Statement::text(int column) const {
  expectType(column, SQLITE_TEXT);
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
  if (bytes == nullptr) throw SqliteError("out of memory");
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

std::span<const std::uint8_t> Statement::blob(int column) const {
  if (sqlite3_column_type(handle_.get(), column) == SQLITE_NULL) return {};
  expectType(column, SQLITE_BLOB);
  const auto* bytes = static_cast<const std::uint8_t*>(sqlite3_column_blob(handle_.get(), column));
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

std::string Statement::shown(int column) const {
  switch (sqlite3_column_type(handle_.get(), column)) {
    case SQLITE_INTEGER:
      return fmt::format("{}", integer(column));
    case SQLITE_FLOAT:
      return fmt::format("{}", sqlite3_column_double(handle_.get(), column));
    case SQLITE_TEXT:
      return sqlite::quoted(text(column));
    case SQLITE_BLOB:
      return fmt::format("{} bytes", sqlite3_column_bytes(handle_.get(), column));
    default:
      return "NULL";
  }
}

Transaction::Transaction(Database& database) : database_(database) {
  database_.execute("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  if (open_) sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
  database_.execute("COMMIT");
  open_ = false;
}

}  // namespace parkade::sqlite
