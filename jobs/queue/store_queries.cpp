#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "jobs/queue/rows.h"
#include "jobs/queue/store.h"

namespace lacuna {
namespace {

constexpr const char* not_over = "state NOT IN ('done', 'failed', 'cancelled')";

std::int64_t number_of(const std::string& cursor) {
  std::int64_t number = 0;
  const char* end = cursor.data() + cursor.size();
  const auto read = std::from_chars(cursor.data(), end, number);
  if (read.ec != std::errc() || read.ptr != end) {
    throw std::invalid_argument("it is not the `next` of a page");
  }
  return number;
}

/// The condition of a query, except the states, with its values.
struct Condition {
  std::string sql = "number<?";
  std::int64_t before = INT64_MAX;
  std::vector<std::string> texts;
};

Condition condition_of(const JobQuery& query) {
  Condition c;
  if (!query.after.empty()) c.before = number_of(query.after);
  if (query.sweep) {
    c.sql += " AND sweep=?";
    c.texts.push_back(*query.sweep);
  }
  if (!query.words.empty()) {
    c.sql +=
        " AND instr(lower(label || char(10) || scene || char(10) || integrator || char(10) || id),"
        " lower(?))";
    c.texts.push_back(query.words);
  }
  return c;
}

void bind(Statement& sql, const Condition& condition, const std::string* state) {
  sql.bind(condition.before);
  for (const std::string& text : condition.texts) sql.bind(text);
  if (state != nullptr) sql.bind(*state);
}

/// The names of the requested states; empty: all.
std::vector<std::string> names_of(const std::vector<State>& states) {
  std::vector<std::string> names;
  names.reserve(states.size());
  for (const State s : states) names.emplace_back(enum_name(s));
  return names;
}

/// Runs the query once for each state, so that the index of each state returns its jobs in order.
template <class Use>
void for_each_state(const Database& database, const std::string& of_one, const JobQuery& query,
                    const Condition& condition, const Use& use) {
  const std::vector<std::string> states = names_of(query.states);
  if (states.empty()) {
    Statement sql(database, of_one);
    bind(sql, condition, nullptr);
    use(sql);
  }
  for (const std::string& state : states) {
    Statement sql(database, [&] {
      std::string text = of_one;
      return text.insert(text.find(condition.sql) + condition.sql.size(), " AND state=?");
    }());
    bind(sql, condition, &state);
    use(sql);
  }
}

/// Whether the id, or that of one of `runs` runs of a sweep with this id, belongs to a job or a
/// sweep or can become that of a sweep's run. Only ids of the same second can.
bool is_taken(const Database& database, const std::string& id, std::size_t runs) {
  constexpr std::size_t to_the_second = std::string_view("20260131-235959-").size();
  const std::string second = id.substr(0, to_the_second);
  const auto is_mine = [&](const std::string& other) {
    const auto index = run_index(id, other);
    return other == id || (index && *index < runs);
  };
  Statement jobs(database, "SELECT id FROM jobs WHERE id>=? AND id<?");
  jobs.bind(second).bind(second + "~");
  while (jobs.step()) {
    if (is_mine(jobs.text(0))) return true;
  }
  for (const SweepEntry& sweep :
       rows::select<SweepEntry>(database, "WHERE id>=? AND id<?", second, second + "~")) {
    const auto index = run_index(sweep.id, id);
    if (is_mine(sweep.id) || (index && *index < sweep.runs)) return true;
    // Its first run is among the new ids.
    if (is_mine(run_job_id(sweep.id, 0))) return true;
  }
  return false;
}

}  // namespace

bool Store::has_imported() const {
  const std::lock_guard lock(mutex_);
  Statement query(database_, "SELECT 1 FROM facts WHERE name='imported'");
  return query.step();
}

std::optional<JobEntry> Store::find(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  auto entry = rows::job(database_, id);
  if (!entry) return std::nullopt;
  return with_live(std::move(*entry));
}

std::optional<SweepEntry> Store::find_sweep(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  return rows::first<SweepEntry>(database_, "WHERE id=?", id);
}

JobPage Store::list(const JobQuery& query) const {
  const Condition condition = condition_of(query);
  JobPage page;
  page.counts = counts();
  const std::lock_guard lock(mutex_);
  page.last_event = journal_.name(journal_.last());
  if (query.words.empty()) {
    const Counts counts = query.sweep ? run_counts(*query.sweep) : page.counts;
    for (const auto& [state, n] : counts) {
      const auto& wanted = query.states;
      const bool counts_in =
          wanted.empty() || std::find(wanted.begin(), wanted.end(), state) != wanted.end();
      page.total += counts_in ? n : 0;
    }
  } else {
    Condition all = condition;
    all.before = INT64_MAX;
    for_each_state(database_, "SELECT count(*) FROM jobs WHERE " + all.sql, query, all,
                   [&](Statement& sql) {
                     sql.step();
                     page.total += static_cast<std::size_t>(sql.integer(0));
                   });
  }
  const std::string of_one = "SELECT " + columns<JobEntry>().names + " FROM jobs WHERE " +
                             condition.sql + " ORDER BY number DESC LIMIT " +
                             std::to_string(query.limit + 1);
  for_each_state(database_, of_one, query, condition, [&](Statement& sql) {
    while (sql.step()) page.jobs.push_back(with_live(read_row<JobEntry>(sql)));
  });
  std::sort(page.jobs.begin(), page.jobs.end(),
            [](const JobEntry& a, const JobEntry& b) { return a.number > b.number; });
  if (page.jobs.size() > query.limit) {
    page.jobs.resize(query.limit);
    page.next = std::to_string(page.jobs.back().number);
  }
  return page;
}

std::vector<SweepEntry> Store::sweeps() const {
  const std::lock_guard lock(mutex_);
  return rows::select<SweepEntry>(database_, "ORDER BY number DESC");
}

std::vector<SweepEntry> Store::unfinished_sweeps() const {
  const std::lock_guard lock(mutex_);
  return rows::select<SweepEntry>(database_,
                                  "WHERE state IN ('running', 'cancelling') ORDER BY number");
}

std::vector<JobEntry> Store::unfinished(std::size_t begin, std::size_t n) const {
  const std::lock_guard lock(mutex_);
  return rows::select<JobEntry>(database_,
                                std::string("WHERE ") + rows::in_line +
                                    " ORDER BY begun DESC, priority DESC, number LIMIT ? OFFSET ?",
                                static_cast<std::int64_t>(n), static_cast<std::int64_t>(begin));
}

std::vector<JobEntry> Store::runs(const std::string& sweep) const {
  const std::lock_guard lock(mutex_);
  return rows::select<JobEntry>(database_, "WHERE sweep=? ORDER BY number", sweep);
}

std::vector<JobEntry> Store::unfinished_runs(const std::string& sweep) const {
  if (unfinished_of(run_counts(sweep)) == 0) return {};
  const std::lock_guard lock(mutex_);
  auto runs =
      rows::select<JobEntry>(database_, std::string("WHERE sweep=? AND ") + not_over, sweep);
  for (JobEntry& run : runs) run = with_live(std::move(run));
  return runs;
}

std::int64_t Store::latest_change(const std::string& sweep) const {
  const std::lock_guard lock(mutex_);
  Statement latest(database_, "SELECT max(revision) FROM jobs WHERE sweep=?");
  latest.bind(sweep).step();
  return latest.integer(0);
}

std::optional<JobEntry> Store::merged_from(const std::string& sweep) const {
  if (sweep.empty()) return std::nullopt;
  const std::lock_guard lock(mutex_);
  return rows::first<JobEntry>(database_, "WHERE shards=? AND shards != ''", sweep);
}

std::optional<std::string> Store::measured_against(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto user = rows::first<JobEntry>(
      database_, std::string("WHERE reference=? AND reference != '' AND ") + not_over, id);
  if (!user) return std::nullopt;
  return user->id;
}

std::string Store::free_job_id() const {
  for (;;) {
    std::string id = new_job_id();
    const std::lock_guard lock(mutex_);
    if (!is_taken(database_, id, 0)) return id;
  }
}

std::string Store::free_sweep_id(std::size_t runs) const {
  for (;;) {
    std::string id = new_job_id();
    const std::lock_guard lock(mutex_);
    if (!is_taken(database_, id, runs)) return id;
  }
}

std::vector<JobEntry> Store::removable() const {
  const std::lock_guard lock(mutex_);
  return rows::select<JobEntry>(
      database_,
      "WHERE state IN ('done', 'failed', 'cancelled')"
      " AND sweep NOT IN (SELECT id FROM sweeps WHERE state IN ('running', 'cancelling'))"
      " AND id NOT IN (SELECT reference FROM jobs WHERE reference != '') ORDER BY number");
}

}  // namespace lacuna
