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

/// How many jobs there are in each state.
using Counts = std::map<State, std::size_t>;
std::size_t all_of(const Counts& counts);
std::size_t unfinished_of(const Counts& counts);  ///< that are not over

/// A part of the list of jobs, newest first.
struct JobQuery {
  std::vector<State> states = {};  ///< any of these; empty: all
  std::string words = {};          ///< somewhere in label, scene, integrator or id, in any case
  std::optional<std::string> sweep = {};  ///< the runs of this one only; empty: jobs of no sweep
  std::size_t limit = 100;
  std::string after = {};  ///< the `next` of the page before; empty: from the newest on
};
struct JobPage {
  std::vector<JobEntry> jobs;
  std::size_t total = 0;  ///< that match, on all pages
  Counts counts;          ///< of all jobs
  std::string next;       ///< empty: this was the last page
  std::string last_event;
};

/// The progress of a running job, as its renderer last wrote it. In memory only.
struct LiveState {
  std::string phase = {}, place = {};
  std::vector<std::string> warnings = {};
  std::optional<Progress> progress = {};
  bool pictured = false;
  bool operator==(const LiveState&) const = default;
};

/// A part of a transaction: what it reads includes what it has changed.
class StoreChange {
 public:
  std::optional<JobEntry> find_job(const std::string& id) const;
  std::vector<JobEntry> begun_jobs() const;
  /// Gives the entry its number.
  void add(JobEntry& entry);
  /// Replaces the job of the entry's id; nothing happens if it is the same.
  void put(JobEntry entry);
  void remove_job(const std::string& id);
  std::optional<SweepEntry> find_sweep(const std::string& id) const;
  /// Gives the entry its number.
  void add(SweepEntry& entry);
  void put(SweepEntry entry);
  void remove_sweep(const std::string& id);
  /// The store has taken over what lay in folders (import_folders()).
  void note_import();
  /// The job or sweep that this key has made; nothing: none.
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

/// The jobs and sweeps of a queue in a database, the only truth about them; results lie in the
/// jobs' folders. A change is a transaction: it is on disk when change() returns, or nothing has
/// changed. Thread-safe. All calls that read or write throw as Database does.
class Store {
 public:
  /// Opens the database, or makes it. Throws DatabaseInUse if another process has it.
  explicit Store(const std::filesystem::path& file);

  /// Makes a change, with those of other threads in one commit. What `make` throws is thrown, and
  /// nothing of it has changed; it may be called on another thread.
  void change(const std::function<void(StoreChange&)>& make);

  bool has_imported() const;
  std::optional<JobEntry> find(const std::string& id) const;
  std::optional<SweepEntry> find_sweep(const std::string& id) const;
  /// Throws std::invalid_argument if `after` is no cursor.
  JobPage list(const JobQuery& query) const;
  /// Newest first.
  std::vector<SweepEntry> sweeps() const;
  /// Those that are not over, oldest first.
  std::vector<SweepEntry> unfinished_sweeps() const;

  /// At most `n` of the unfinished jobs that are not held, after the first `begin`, in the order in
  /// which they are to be rendered: those that have begun, then by priority, then first come, first
  /// served.
  std::vector<JobEntry> unfinished(std::size_t begin, std::size_t n) const;
  /// The runs of a sweep that are there as jobs, in the order of their numbers.
  std::vector<JobEntry> runs(const std::string& sweep) const;
  std::vector<JobEntry> unfinished_runs(const std::string& sweep) const;
  /// Number of the latest change of any of its runs; 0: there is none.
  std::int64_t latest_change(const std::string& sweep) const;
  /// The job that is merged from the runs of this sweep; nothing: none is.
  std::optional<JobEntry> merged_from(const std::string& sweep) const;
  /// An unfinished job whose reference is this one; nothing: there is none.
  std::optional<std::string> measured_against(const std::string& id) const;
  /// An id for a new job, or for a new sweep with so many runs: neither it nor any of its runs' ids
  /// is there, or can be that of another sweep's run.
  std::string free_job_id() const;
  std::string free_sweep_id(std::size_t runs) const;
  /// The jobs that are over, of no unfinished sweep and no other job's reference, oldest first.
  std::vector<JobEntry> removable() const;

  // These never wait for the disk:
  /// How many jobs there are in each state: all, or the runs of a sweep.
  Counts counts() const;
  Counts run_counts(const std::string& sweep) const;

  /// What is known of a job that has begun but not stored. It is forgotten with the renderer's end.
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

  mutable std::mutex mutex_;  // guards the next two; held while the disk is waited for
  Database database_;
  std::int64_t number_ = 0;  // of events and of what is accepted: given last
  Journal journal_;
  mutable std::mutex counts_mutex_;       // guards the next two; nothing is waited for under it
  std::map<std::string, Counts> counts_;  // of sweeps; "": of jobs of none
  std::map<std::string, LiveState> live_;
  Line line_;
};

}  // namespace lacuna
