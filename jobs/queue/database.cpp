#include "jobs/queue/database.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cerrno>
#include <system_error>

namespace lacuna {
namespace {

/// The errno for a result of SQLite; 0: none. `system`: errno of the failed call.
int errno_of(int code, int system) {
  switch (code & 0xff) {
    case SQLITE_FULL:
      return ENOSPC;
    case SQLITE_READONLY:
      return EROFS;
    case SQLITE_NOMEM:
      return ENOMEM;
    case SQLITE_PERM:
      return EACCES;
    case SQLITE_CANTOPEN:
    case SQLITE_IOERR:
      return system != 0 ? system : EIO;
    default:
      return 0;
  }
}

}  // namespace

Database::Database(const std::filesystem::path& file) : file_(file) {
  const int code = sqlite3_open_v2(
      file.c_str(), &handle_,
      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE,
      nullptr);
  try {
    if (code != SQLITE_OK) fail(code);
    // A killed service leaves no lock; one that is stopping may need a moment.
    sqlite3_busy_timeout(handle_, 3000);
    // Locking mode before WAL: SQLite then keeps the WAL index in its own memory instead of shared
    // memory, which network file systems do not support.
    run("PRAGMA locking_mode=EXCLUSIVE");
    run("PRAGMA journal_mode=WAL");
    run("PRAGMA synchronous=FULL");
    run("BEGIN IMMEDIATE; COMMIT");
  } catch (...) {
    sqlite3_close(handle_);
    throw;
  }
}

Database::~Database() { sqlite3_close(handle_); }

void Database::run(const char* sql) {
  const int code = sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code);
}

bool Database::in_transaction() const { return sqlite3_get_autocommit(handle_) == 0; }

void Database::fail(int code) const {
  const char* said = handle_ != nullptr ? sqlite3_errmsg(handle_) : sqlite3_errstr(code);
  const std::string text = fmt::format("{}: {}", file_.string(), said);
  const int error = errno_of(code, handle_ != nullptr ? sqlite3_system_errno(handle_) : errno);
  if (error != 0) throw std::system_error(error, std::generic_category(), text);
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw DatabaseInUse(fmt::format("{} is in use by another process", file_.string()));
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      throw DatabaseDamaged(text);
    default:
      throw std::logic_error(text);
  }
}

Statement::Statement(const Database& database, std::string_view sql) : database_(database) {
  const int code = sqlite3_prepare_v2(database.handle_, sql.data(), static_cast<int>(sql.size()),
                                      &statement_, nullptr);
  if (code != SQLITE_OK) database.fail(code);
}

Statement::~Statement() { sqlite3_finalize(statement_); }

Statement& Statement::bind(std::int64_t value) {
  sqlite3_bind_int64(statement_, ++bound_, value);
  return *this;
}

Statement& Statement::bind(std::string_view value) {
  // A null data pointer would bind NULL.
  sqlite3_bind_text64(statement_, ++bound_, value.empty() ? "" : value.data(), value.size(),
                      SQLITE_TRANSIENT, SQLITE_UTF8);
  return *this;
}

Statement& Statement::bind_null() {
  sqlite3_bind_null(statement_, ++bound_);
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  database_.fail(code);
}

bool Statement::is_null(int i) const { return sqlite3_column_type(statement_, i) == SQLITE_NULL; }

std::int64_t Statement::integer(int i) const { return sqlite3_column_int64(statement_, i); }

std::string Statement::text(int i) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, i));
  return text == nullptr
             ? std::string()
             : std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement_, i)));
}

}  // namespace lacuna
