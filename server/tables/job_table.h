#pragma once

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
#include "server/tables/journal.h"
#include "server/tables/sweep_table.h"

namespace lacuna {

/// The data of one job that the service holds in memory.
struct JobEntry {
  std::string id, label, scene, integrator, reference;
  std::string sweep;  ///< that it is a run of; empty: none
  bool exclusive = false;
  std::string job_hash;  ///< of job.json
  JobState state;
  JobControl control;
  std::optional<Progress> progress;
  bool pictured = false;  ///< image.png is there: the first comes after the first progress
  bool over = false;      ///< terminal, and the queue has nothing more to say about it
  bool damaged = false;   ///< its folder cannot be read; state.error says why
  bool unread = false;    ///< its folder cannot be read for now; `obstacle` says why
  std::string obstacle;   ///< what keeps it from going on, and may pass; empty: nothing
  std::string place;      ///< where its renderer runs or waits; empty: this machine, or nowhere

  // Made by the table from the above:
  std::string text;      ///< as an element of the API's list, JSON
  std::string revision;  ///< changes with the job, its state and the requests for it
  std::string words;     ///< in lower case: what a search by words looks at
};
using EntryPtr = std::shared_ptr<const JobEntry>;

/// All jobs of a service in memory, and the journal of their changes. The folders are the source of
/// truth, from which the table is read at the start and updated. Thread-safe; a returned entry
/// never changes.
class JobTable {
 public:
  /// `sweeps` outlives it, and knows a sweep before any of its jobs is there.
  JobTable(DataRoot data, const SweepTable& sweeps) : data_(std::move(data)), sweeps_(sweeps) {}

  /// Reads every folder that is not known yet and forgets those that are gone.
  void rescan();
  /// rescan(), if a folder was added or removed by somebody since the last one.
  /// Whether it was.
  bool rescan_if_changed();

  /// Nothing if there is no such job.
  EntryPtr find(const std::string& id) const;
  JobFolder folder(const std::string& id) const { return JobFolder(data_.jobs() / id); }

  /// A job whose folder is complete on disk: reads it. Where that fails for a reason that may pass,
  /// the entry is `unread` until reread().
  EntryPtr add(const std::string& id);
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
  const SweepTable& sweeps() const { return sweeps_; }
  const DataRoot& data() const { return data_; }

  Journal& journal() { return journal_; }
  const Journal& journal() const { return journal_; }

 private:
  using Place = std::pair<std::string, std::string>;  // time of creation, id
  void add_all(const std::vector<std::string>& ids);
  std::size_t count(const Query& query) const;
  void put_in(const Place& place, EntryPtr entry);
  EntryPtr take_out(const std::string& id);
  template <class Change>
  void change(const std::string& id, Change&& change);
  void put(std::shared_ptr<JobEntry> entry, JobEvent::Kind kind);

  const DataRoot data_;
  const SweepTable& sweeps_;
  Journal journal_;
  mutable std::mutex mutex_;  // guards all below
  std::map<Place, EntryPtr> jobs_;
  std::map<std::string, Place, std::less<>> places_;
  Counts counts_;
  std::map<std::string, RunCounts> run_counts_;  // of sweeps; "": of jobs of none
  std::int64_t scanned_ = -1;  // the folder's time of change when it was last read
};

}  // namespace lacuna
