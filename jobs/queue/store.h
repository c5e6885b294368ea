#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "jobs/queue/commit_line.h"
#include "jobs/queue/database.h"
#include "jobs/queue/job_entry.h"
#include "jobs/queue/journal.h"
#include "jobs/queue/sweep_entry.h"

namespace lacuna {

/// Number of jobs in each state.
using Counts = std::map<State, std::size_t>;
std::size_t all_of(const Counts& counts);
std::size_t unfinished_of(const Counts& counts);  ///< jobs that are not over

/// A query for a page of the list of jobs, newest first.
struct JobQuery {
  std::vector<State> states = {};  ///< any of these; empty: all
  std::string words = {};          ///< substring of label, scene, integrator or id, ignoring case
  std::optional<std::string> sweep = {};  ///< only the runs of this sweep; empty: jobs of no sweep
  std::size_t limit = 100;
  std::string after = {};  ///< `next` of the previous page; empty: the first page
};
struct JobPage {
  std::vector<JobEntry> jobs;
  std::size_t total = 0;  ///< matching jobs on all pages
  Counts counts;          ///< of all jobs
  std::string next;       ///< empty: this is the last page
  std::string last_event;
};

/// The latest progress that the renderer of a running job wrote. In memory only.
struct LiveState {
  std::string phase = {}, place = {};
  std::vector<std::string> warnings = {};
  std::optional<Progress> progress = {};
  bool pictured = false;
  bool operator==(const LiveState&) const = default;
};

/// A part of a transaction; its reads see its own changes.
class StoreChange {
 public:
  std::optional<JobEntry> find_job(const std::string& id) const;
  std::vector<JobEntry> begun_jobs() const;
  /// Sets the entry's number.
  void add(JobEntry& entry);
  /// Replaces the job with the entry's id; does nothing if they are equal.
  void put(JobEntry entry);
  void remove_job(const std::string& id);
  std::optional<SweepEntry> find_sweep(const std::string& id) const;
  /// Sets the entry's number.
  void add(SweepEntry& entry);
  void put(SweepEntry entry);
  void remove_sweep(const std::string& id);
  /// Records that the store has imported its folders (import_folders()).
  void note_import();
  /// The job or sweep created with this key, if any.
  std::optional<JobEntry> job_of_key(const std::string& key) const;
  std::optional<SweepEntry> sweep_of_key(const std::string& key) const;

 private:
  friend class Store;
  StoreChange(class Store& store, std::int64_t number) : store_(store), number_(number) {}
  struct Effect {
    std::int64_t number;  // of the event
    std::optional<JobEntry> before, after;
  };
  Store& store_;
  std::int64_t number_;  // used last
  std::vector<Effect> effects_;
};

/// The jobs and sweeps of a queue in a database, the source of truth about them; results lie in the
/// jobs' folders. A change is a transaction: it is on disk when change() returns, or nothing has
/// changed. Thread-safe. All calls that read or write throw the exceptions of Database.
class Store {
 public:
  /// Opens or creates the database. Throws DatabaseInUse if another process has it open.
  explicit Store(const std::filesystem::path& file);

  /// Makes a change, in one commit with those of other threads. Rethrows the exceptions of `make`,
  /// whose changes are undone then; `make` may be called on another thread.
  void change(const std::function<void(StoreChange&)>& make);

  bool has_imported() const;
  std::optional<JobEntry> find(const std::string& id) const;
  std::optional<SweepEntry> find_sweep(const std::string& id) const;
  /// Throws std::invalid_argument if `after` is not a cursor.
  JobPage list(const JobQuery& query) const;
  /// Newest first.
  std::vector<SweepEntry> sweeps() const;
  /// The sweeps that are not over, oldest first.
  std::vector<SweepEntry> unfinished_sweeps() const;

  /// At most `n` of the unfinished jobs that are not held, after the first `begin`, in the order of
  /// rendering: those that have begun, then by priority, then first come, first served.
  std::vector<JobEntry> unfinished(std::size_t begin, std::size_t n) const;
  /// The runs of a sweep that exist as jobs, in the order of their numbers.
  std::vector<JobEntry> runs(const std::string& sweep) const;
  std::vector<JobEntry> unfinished_runs(const std::string& sweep) const;
  /// Number of the latest change of any of its runs; 0: none.
  std::int64_t latest_change(const std::string& sweep) const;
  /// The job that is merged from the runs of this sweep, if any.
  std::optional<JobEntry> merged_from(const std::string& sweep) const;
  /// An unfinished job whose reference is this one, if any.
  std::optional<std::string> measured_against(const std::string& id) const;
  /// An unused id for a new job, or for a new sweep with this number of runs: neither it nor the
  /// ids of its runs exist, or can become that of another sweep's run.
  std::string free_job_id() const;
  std::string free_sweep_id(std::size_t runs) const;
  /// The jobs that are over, not runs of an unfinished sweep and not another job's reference,
  /// oldest first.
  std::vector<JobEntry> removable() const;

  // These never wait for the disk:
  /// Number of jobs in each state: all, or the runs of a sweep.
  Counts counts() const;
  Counts run_counts(const std::string& sweep) const;

  /// Sets the unstored state of a running job, which is dropped when its renderer ends.
  void set_live(const std::string& id, const LiveState& live);

  Journal& journal() { return journal_; }
  const Journal& journal() const { return journal_; }

 private:
  friend class StoreChange;
  using Line = CommitLine<StoreChange>;
  void make_tables();
  void remember_events();
  void commit(const Line::Batch& batch);
  void make_each(const Line::Batch& batch, std::vector<StoreChange::Effect>& effects);
  void overwrite_failed_commit();
  void take_effect(const StoreChange::Effect& effect);
  void count(const JobEntry& entry, int sign);
  JobEntry with_live(JobEntry entry) const;

  mutable std::mutex mutex_;  // guards the next two; held during disk access
  Database database_;
  std::int64_t number_ = 0;  // the last number of an event, job or sweep
  Journal journal_;
  mutable std::mutex counts_mutex_;       // guards the next two; never held during a wait
  std::map<std::string, Counts> counts_;  // by sweep; "": jobs of no sweep
  std::map<std::string, LiveState> live_;
  Line line_;
};

}  // namespace lacuna
