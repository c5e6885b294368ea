#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/queue/columns.h"
#include "jobs/queue/job_entry.h"
#include "jobs/queue/sweep_entry.h"

namespace lacuna::rows {

/// The SQL condition for jobs that wait or run, without held ones. The index jobs_line applies to
/// queries with exactly this text.
inline constexpr const char* in_line = "state IN ('queued', 'running', 'cancelling')";

template <class Row>
constexpr const char* table = "jobs";
template <>
inline constexpr const char* table<SweepEntry> = "sweeps";

/// The rows of a table that `tail` (WHERE, ORDER BY, LIMIT) selects, with its parameters.
template <class Row, class... Values>
std::vector<Row> select(const Database& database, std::string_view tail, const Values&... values) {
  Statement query(
      database, "SELECT " + columns<Row>().names + " FROM " + table<Row> + " " + std::string(tail));
  (query.bind(values), ...);
  std::vector<Row> found;
  while (query.step()) found.push_back(read_row<Row>(query));
  return found;
}

template <class Row, class... Values>
std::optional<Row> first(const Database& database, std::string_view tail, const Values&... values) {
  auto found = select<Row>(database, std::string(tail) + " LIMIT 1", values...);
  if (found.empty()) return std::nullopt;
  return std::move(found.front());
}

inline std::optional<JobEntry> job(const Database& database, const std::string& id) {
  return first<JobEntry>(database, "WHERE id=?", id);
}

/// Replaces the row with the same number.
template <class Row>
void put(const Database& database, Row& row) {
  Statement query(database, std::string("UPDATE ") + table<Row> + " SET (" + columns<Row>().names +
                                ")=(" + columns<Row>().places + ") WHERE number=?");
  bind_row(query, row);
  query.bind(row.number).run();
}

template <class Row>
void add(const Database& database, Row& row) {
  Statement query(database, std::string("INSERT INTO ") + table<Row> + "(" + columns<Row>().names +
                                ") VALUES (" + columns<Row>().places + ")");
  bind_row(query, row);
  query.run();
}

}  // namespace lacuna::rows
