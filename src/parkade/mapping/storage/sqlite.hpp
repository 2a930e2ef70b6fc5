// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace parkade::sqlite {

// SQLite's C interface with owners and exceptions, for the sources of map files only; they turn
// SqliteError into an Error at the room's border.

class SqliteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file's text for a message: in quotes, cut to 40 characters, '?' for what cannot be printed.
std::string quoted(std::string_view text);

/// Runs read(), which takes values from a row; name() begins the message of what it throws:
/// "slot 3: x0 is a text ('wide'), expected a number".
template <class Name, class Read>
void namingRow(const Name& name, const Read& read) {
  try {
    read();
  } catch (const SqliteError& error) {
    throw SqliteError(name() + ": " + error.what());
  }
}

class Database {
 public:
  /// kRead may finish or undo what a killed writer left, where the file can be written.
  enum class Mode { kRead, kReadWriteCreate };
  Database(const std::string& path, Mode mode);

  void execute(const std::string& sql);
  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }
  /// Throws with SQLite's message and the file's path.
  [[noreturn]] void fail(const std::string& doing) const;

 private:
  struct Close {
    void operator()(sqlite3* handle) const { sqlite3_close(handle); }
  };
  std::string path_;
  std::unique_ptr<sqlite3, Close> handle_;
};

/// A prepared statement; columns count from 0, parameters from 1.
class Statement {
 public:
  Statement(const Database& database, const std::string& sql);

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);
  Statement& bind(int parameter, std::string_view text);
  Statement& bind(int parameter, std::span<const std::uint8_t> blob);
  /// True while there is a row.
  bool step();
  /// Runs to the end and makes the statement ready for other values.
  void run();

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;  ///< finite, or throws
  [[nodiscard]] std::string text(int column) const;
  /// Valid until the next step.
  [[nodiscard]] std::span<const std::uint8_t> blob(int column) const;
  /// A value of any type for a message: 3, 0.5, 'wide', NULL, 12 bytes.
  [[nodiscard]] std::string shown(int column) const;

 private:
  void check(int code, const char* doing) const;
  [[nodiscard]] std::string columnName(int column) const;
  void expectType(int column, int type) const;

  struct Finalize {
    void operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }
  };
  const Database& database_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
};

/// Rolls back unless committed.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace parkade::sqlite
