#include "jobs/queue/store.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <utility>

#include "jobs/queue/columns.h"
#include "jobs/queue/rows.h"

namespace lacuna {
namespace {

// Version of the tables below; a database of another version is refused.
constexpr int version = 1;

// Numbers reserved for one run of the program: unstored events use some, and none is reused.
constexpr std::int64_t numbers_of_a_run = std::int64_t{1} << 40;

// Number of last changed and last removed jobs that the journal contains after a restart.
constexpr int remembered_after_restart = 1000;

std::string random_word() {
  std::random_device random;
  return fmt::format("{:08x}", random());
}

}  // namespace

Store::Store(const std::filesystem::path& file) : database_(file) {
  Statement known(database_, "PRAGMA user_version");
  known.step();
  const std::int64_t found = known.integer(0);
  known.run();
  if (found == 0) make_tables();
  if (found != 0 && found != version) {
    throw DatabaseDamaged(
        fmt::format("{} is of version {}; allowed: {}", file.string(), found, version));
  }
  remember_events();
  Statement count(database_, "SELECT sweep, state, count(*) FROM jobs GROUP BY sweep, state");
  while (count.step()) {
    for (const auto& state : EnumTable<State>::values) {
      if (state.name != count.text(1)) continue;
      counts_[count.text(0)][state.value] = static_cast<std::size_t>(count.integer(2));
    }
  }
}

void Store::make_tables() {
  const auto table = [](const char* name, const std::string& columns) {
    // The first column is the number.
    const std::string rest = columns.substr(columns.find(','));
    return fmt::format("CREATE TABLE {}(number INTEGER PRIMARY KEY{});", name, rest);
  };
  database_.run(("BEGIN;" + table("jobs", columns<JobEntry>().names) +
                 table("sweeps", columns<SweepEntry>().names) +
                 "CREATE UNIQUE INDEX jobs_id ON jobs(id);"
                 "CREATE UNIQUE INDEX jobs_key ON jobs(key);"
                 "CREATE INDEX jobs_state ON jobs(state, number);"
                 "CREATE INDEX jobs_sweep ON jobs(sweep, number);"
                 "CREATE INDEX jobs_count ON jobs(sweep, state);"
                 "CREATE INDEX jobs_revision ON jobs(revision);"
                 "CREATE INDEX jobs_line ON jobs(begun DESC, priority DESC, number)"
                 "  WHERE " +
                 rows::in_line +
                 ";"
                 "CREATE INDEX jobs_shards ON jobs(shards) WHERE shards != '';"
                 "CREATE INDEX jobs_reference ON jobs(reference) WHERE reference != '';"
                 "CREATE UNIQUE INDEX sweeps_id ON sweeps(id);"
                 "CREATE UNIQUE INDEX sweeps_key ON sweeps(key);"
                 // Events of removed jobs.
                 "CREATE TABLE removed(number INTEGER PRIMARY KEY, id);"
                 "CREATE TABLE facts(name PRIMARY KEY, value);"
                 "INSERT INTO facts VALUES ('name', '" +
                 random_word() + "'), ('numbers', 0);" +
                 fmt::format("PRAGMA user_version={}; COMMIT", version))
                    .c_str());
}

/// Reserves the numbers of this run, and fills the journal with earlier events.
void Store::remember_events() {
  Statement facts(database_,
                  "SELECT (SELECT value FROM facts WHERE name='name'),"
                  " (SELECT value FROM facts WHERE name='numbers')");
  facts.step();
  const std::string name = facts.text(0);
  number_ = facts.integer(1);
  facts.run();
  Statement(database_, "UPDATE facts SET value=? WHERE name='numbers'")
      .bind(number_ + numbers_of_a_run)
      .run();
  std::vector<JobEvent> events;
  std::int64_t forgotten = 0;
  const auto collect = [&](const std::string& table, const std::string& order, const auto& read) {
    Statement query(database_, fmt::format("SELECT * FROM {} ORDER BY {} DESC LIMIT {}", table,
                                           order, remembered_after_restart + 1));
    for (int n = 0; query.step(); ++n) {
      JobEvent event = read(query);
      if (n == remembered_after_restart) {
        forgotten = std::max(forgotten, event.number);
      } else {
        events.push_back(std::move(event));
      }
    }
  };
  collect("jobs", "revision", [](const Statement& row) {
    const auto entry = std::make_shared<const JobEntry>(read_row<JobEntry>(row));
    return JobEvent{entry->revision, JobEvent::Kind::changed, entry->id, entry};
  });
  collect("removed", "number", [](const Statement& row) {
    return JobEvent{row.integer(0), JobEvent::Kind::removed, row.text(1), nullptr};
  });
  Statement(database_, "DELETE FROM removed WHERE number<?").bind(forgotten).run();
  std::sort(events.begin(), events.end(),
            [](const JobEvent& a, const JobEvent& b) { return a.number < b.number; });
  journal_.start(name, forgotten);
  for (JobEvent& event : events) {
    if (event.number > forgotten) journal_.add(std::move(event));
  }
}

void Store::change(const std::function<void(StoreChange&)>& make) {
  Line::Waiting mine{&make};
  line_.join(mine, [this](const Line::Batch& batch) { commit(batch); });
  if (mine.error) std::rethrow_exception(mine.error);
}

void Store::commit(const Line::Batch& batch) {
  const std::lock_guard lock(mutex_);
  std::vector<StoreChange::Effect> effects;
  const std::int64_t before = number_;
  try {
    database_.run("BEGIN IMMEDIATE");
    make_each(batch, effects);
    database_.run("COMMIT");
  } catch (...) {
    number_ = before;
    for (Line::Waiting* w : batch) {
      if (!w->error) w->error = std::current_exception();
    }
    overwrite_failed_commit();
    return;
  }
  for (const auto& effect : effects) take_effect(effect);
}

/// An exception of one change rolls back only that change.
void Store::make_each(const Line::Batch& batch, std::vector<StoreChange::Effect>& effects) {
  for (Line::Waiting* w : batch) {
    database_.run("SAVEPOINT one");
    StoreChange change(*this, number_);
    try {
      (*w->make)(change);
    } catch (...) {
      w->error = std::current_exception();
      if (!database_.in_transaction()) throw;  // the disk has failed: SQLite rolled back everything
      database_.run("ROLLBACK TO one; RELEASE one");
      continue;
    }
    database_.run("RELEASE one");
    number_ = change.number_;
    std::move(change.effects_.begin(), change.effects_.end(), std::back_inserter(effects));
  }
}

/// A commit whose sync failed may be complete in the WAL and would be found there after a crash,
/// until the next commit overwrites it. So this makes one at once; if the disk refuses it, too, the
/// next successful commit does so.
void Store::overwrite_failed_commit() {
  try {
    if (database_.in_transaction()) database_.run("ROLLBACK");
    database_.run("UPDATE facts SET value=value+1 WHERE name='numbers'");
  } catch (const std::exception&) {
    // The caller gets the error of the commit.
  }
}

void Store::take_effect(const StoreChange::Effect& effect) {
  {
    const std::lock_guard lock(counts_mutex_);
    if (effect.before) count(*effect.before, -1);
    if (effect.after) count(*effect.after, 1);
    if (effect.before && !(effect.after && effect.after->begun)) live_.erase(effect.before->id);
  }
  const std::string& id = effect.after ? effect.after->id : effect.before->id;
  if (effect.after) {
    journal_.add({effect.number, JobEvent::Kind::changed, id,
                  std::make_shared<const JobEntry>(with_live(*effect.after))});
  } else {
    journal_.add({effect.number, JobEvent::Kind::removed, id, nullptr});
  }
}

/// Only under counts_mutex_.
void Store::count(const JobEntry& entry, int sign) {
  Counts& counts = counts_[entry.sweep];
  if ((counts[entry.state.state] += static_cast<std::size_t>(sign)) == 0) {
    counts.erase(entry.state.state);
  }
  if (counts.empty()) counts_.erase(entry.sweep);
}

void Store::set_live(const std::string& id, const LiveState& live) {
  const std::lock_guard lock(mutex_);
  auto entry = rows::job(database_, id);
  if (!entry || !entry->begun) return;
  {
    const std::lock_guard counts_lock(counts_mutex_);
    LiveState& known = live_[id];
    if (known == live) return;
    known = live;
  }
  journal_.add({++number_, JobEvent::Kind::progress, id,
                std::make_shared<const JobEntry>(with_live(std::move(*entry)))});
}

JobEntry Store::with_live(JobEntry entry) const {
  const std::lock_guard lock(counts_mutex_);
  const auto live = live_.find(entry.id);
  if (live == live_.end()) return entry;
  entry.state.phase = live->second.phase;
  entry.state.warnings = live->second.warnings;
  entry.place = live->second.place;
  if (live->second.progress) entry.progress = live->second.progress;
  entry.pictured = live->second.pictured;
  return entry;
}

Counts Store::counts() const {
  Counts all;
  for (const auto& state : EnumTable<State>::values) all[state.value] = 0;
  const std::lock_guard lock(counts_mutex_);
  for (const auto& [sweep, counts] : counts_) {
    for (const auto& [state, n] : counts) all[state] += n;
  }
  return all;
}

Counts Store::run_counts(const std::string& sweep) const {
  const std::lock_guard lock(counts_mutex_);
  const auto found = counts_.find(sweep);
  return found == counts_.end() ? Counts{} : found->second;
}

std::size_t unfinished_of(const Counts& counts) {
  std::size_t sum = 0;
  for (const auto& [state, n] : counts) sum += is_terminal(state) ? 0 : n;
  return sum;
}

std::size_t all_of(const Counts& counts) {
  std::size_t sum = 0;
  for (const auto& [state, n] : counts) sum += n;
  return sum;
}

}  // namespace lacuna
