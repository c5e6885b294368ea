#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "jobs/store/job_folder.h"
#include "server/tables/job_entry.h"
#include "server/tables/journal.h"
#include "server/tables/sweep_table.h"

namespace lacuna {

/// When the index of jobs is used and written.
struct IndexSettings {
  std::size_t least_jobs = 1000;  ///< fewer are read as fast from their folders
  /// Each index is written as a whole: only once so many jobs, or a hundredth of all, are not in
  /// it.
  std::size_t least_missing = 100;
  /// A folder that has changed within this time is not taken into it, or from it: longer than the
  /// steps of any file system's clock in use; those of FAT are two seconds.
  std::chrono::nanoseconds settled = std::chrono::seconds(3);
};

/// All jobs of a service in memory, and the journal of their changes. The folders are the source of
/// truth, from which the table is read at the start and updated. Thread-safe; a returned entry
/// never changes.
class JobTable {
 public:
  /// `sweeps` outlives it, and knows a sweep before any of its jobs is there.
  JobTable(DataRoot data, const SweepTable& sweeps, IndexSettings index = {})
      : data_(std::move(data)), sweeps_(sweeps), index_(index) {}

  /// Reads every folder that is not known yet and forgets those that are gone. The first time it
  /// takes from the index what that still knows.
  void rescan();
  /// Writes the index of the jobs that are over, if enough has changed since it was written or
  /// read, and there are so many jobs that it pays: for the next start. Throws std::system_error.
  void save_index();
  /// rescan(), if a folder was added or removed by somebody since the last one.
  /// Whether it was.
  bool rescan_if_changed();

  /// Nothing if there is no such job.
  EntryPtr find(const std::string& id) const;
  JobFolder folder(const std::string& id) const { return JobFolder(data_.jobs() / id); }

  /// A job whose folder is complete on disk: reads it. Where that fails for a reason that may pass,
  /// the entry is `unread` until reread().
  EntryPtr add(const std::string& id) { return add(id, 0); }
  /// Reads the folder of a job anew; nothing if the table has no such job any more. Throws what may
  /// pass (may_pass()).
  EntryPtr reread(const std::string& id);
  void remove(const std::string& id);

  /// Each puts a new value in the place of the old one and tells the journal, if it differs;
  /// nothing happens for a job that is not there.
  void set_state(const std::string& id, const JobState& state, bool over);
  void set_control(const std::string& id, const JobControl& control);
  void set_obstacle(const std::string& id, const std::string& obstacle);
  void set_place(const std::string& id, const std::string& place);
  /// Looks for the picture, too.
  void set_progress(const std::string& id, const Progress& progress);
  /// Looks for its sweep, which may have been made after it.
  void find_sweep(const std::string& id);
  /// Its job.json says this now.
  void set_job(const std::string& id, const JobSpec& spec);

  using Counts = std::map<State, std::size_t>;

  /// A part of the list, newest first.
  struct Query {
    std::vector<State> states;         ///< any of these; empty: all
    std::string words;                 ///< somewhere in label, scene, integrator or id, in any case
    std::optional<std::string> sweep;  ///< the runs of this one only; empty: jobs of no sweep
    std::size_t limit = 100;
    std::string after;  ///< the `next` of the page before; empty: from the newest on
  };
  struct Page {
    std::vector<EntryPtr> jobs;
    std::size_t total = 0;  ///< that match, on all pages
    Counts counts;          ///< of all jobs
    std::string next;       ///< empty: this was the last page
    std::string last_event;
  };
  /// Throws std::invalid_argument if `after` is no cursor.
  Page list(const Query& query) const;
  /// All of them, oldest first.
  std::vector<EntryPtr> all() const;

  /// How many jobs there are in each state.
  Counts counts() const;

  /// The runs of a sweep that are there as jobs.
  struct RunCounts {
    Counts counts;
    std::set<std::string> unfinished;  ///< their ids
    std::size_t jobs() const;
  };
  RunCounts run_counts(const std::string& sweep) const;
  /// The job that the runs of this sweep are shards of; nothing: they are of none.
  EntryPtr merged_from(const std::string& sweep) const;
  /// Jobs that are not over and whose sweep of shards is not there.
  std::vector<EntryPtr> without_shards() const;
  /// An unfinished job whose reference is this one; nothing: there is none.
  std::optional<std::string> measured_against(const std::string& id) const;
  /// A job whose folder cannot be read now, so that nobody knows which others it needs; nothing:
  /// there is none.
  EntryPtr unread() const;
  /// Whether its shards are still to be rendered: their sweep, or a run of it, is not over, or is
  /// not made yet.
  bool waits_for_shards(const JobEntry& entry) const;
  const SweepTable& sweeps() const { return sweeps_; }
  const DataRoot& data() const { return data_; }

  Journal& journal() { return journal_; }
  const Journal& journal() const { return journal_; }

 private:
  using Place = std::pair<std::string_view, std::string_view>;  // time of creation, id
  struct ByPlace {
    using is_transparent = void;
    static Place place(const EntryPtr& entry) { return {entry->state.created, entry->id}; }
    static const Place& place(const Place& place) { return place; }
    template <class A, class B>
    bool operator()(const A& a, const B& b) const {
      return place(a) < place(b);
    }
  };
  std::filesystem::path index_file() const { return data_.dir / "jobs.index"; }
  std::int64_t settled_before() const;
  void add_indexed(const std::vector<std::string>& there, std::int64_t settled_before);
  void add_all(const std::vector<std::string>& ids, std::int64_t settled_before);
  EntryPtr add(const std::string& id, std::int64_t settled_before);
  std::pair<std::vector<std::string>, std::vector<std::string>> compare(
      const std::vector<std::string>& there) const;
  EntryPtr stamped(const EntryPtr& entry, std::int64_t settled_before);
  std::size_t count(const Query& query) const;
  void put_in(EntryPtr entry);
  EntryPtr take_out(const std::string& id);
  template <class Change>
  void change(const std::string& id, Change&& change);
  void put(std::shared_ptr<JobEntry> entry, JobEvent::Kind kind);

  const DataRoot data_;
  const SweepTable& sweeps_;
  const IndexSettings index_;
  Journal journal_;
  mutable std::mutex mutex_;  // guards all below
  std::set<EntryPtr, ByPlace> jobs_;
  std::map<std::string_view, EntryPtr> by_id_;  // a key lies in its entry
  Counts counts_;
  std::map<std::string, RunCounts> run_counts_;  // of sweeps; "": of jobs of none
  std::map<std::string, std::string> merged_;    // sweeps of shards, and the job of each
  std::set<std::string> unmerged_;               // those jobs that are not over
  // References of jobs that are not over, and these jobs.
  std::set<std::pair<std::string, std::string>> measured_;
  std::set<std::string> unread_;
  std::int64_t scanned_ = -1;    // the folder's time of change when it was last read
  std::size_t not_indexed_ = 0;  // jobs that have come to an end, or are gone, since the index
};

}  // namespace lacuna
