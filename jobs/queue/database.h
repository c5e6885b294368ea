#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace lacuna {

/// The file is damaged, or is not a database of this program's version.
class DatabaseDamaged : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
/// Another process has the database open.
class DatabaseInUse : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One SQLite database with one owner: write-ahead log, every commit synced, locked while it is
/// open. For one thread at a time. All calls throw DatabaseDamaged, DatabaseInUse, and
/// std::system_error with an errno if the file cannot be read or written.
class Database {
 public:
  /// Opens or creates the file.
  explicit Database(const std::filesystem::path& file);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// Runs statements that return no rows.
  void run(const char* sql);
  bool in_transaction() const;
  /// Throws the exception for the result `code` of a call.
  [[noreturn]] void fail(int code) const;

 private:
  friend class Statement;
  const std::filesystem::path file_;
  sqlite3* handle_ = nullptr;
};

/// A statement with its parameters, and its current row.
class Statement {
 public:
  Statement(const Database& database, std::string_view sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  /// Sets the next parameter.
  Statement& bind(std::int64_t value);
  Statement& bind(std::string_view value);
  Statement& bind_null();

  /// Moves to the next row; false if there is none.
  bool step();
  /// Runs it to the end.
  void run() {
    while (step()) {
    }
  }

  // Column `i` of the row, counted from 0.
  bool is_null(int i) const;
  std::int64_t integer(int i) const;
  std::string text(int i) const;

 private:
  const Database& database_;
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0;
};

}  // namespace lacuna
