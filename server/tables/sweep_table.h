#pragma once

#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

/// The data of one sweep that the service holds in memory.
struct SweepEntry {
  std::string id, label;
  SweepState state;
  bool unread = false;  ///< its folder cannot be read for now: of `state` nothing is known
  std::string error;    ///< of `failed`: what is wrong with its folder; of `unread`: why
};
using SweepEntryPtr = std::shared_ptr<const SweepEntry>;

/// All sweeps of a service in memory. The folders are the source of truth: the table is read from
/// them at the start, and changes are written to them first. Thread-safe; a returned entry never
/// changes.
class SweepTable {
 public:
  explicit SweepTable(DataRoot data) : data_(std::move(data)) {}

  /// Reads every folder: once, before jobs are looked for.
  void read();

  /// Nothing if there is no such sweep.
  SweepEntryPtr find(const std::string& id) const;
  /// All of them, oldest first.
  std::vector<SweepEntryPtr> all() const;
  /// Reads an `unread` sweep again. True: it can be read now, or is damaged.
  bool reread(const std::string& id);
  /// The sweep that a job is a run of; empty: none. One that is `unread` may have any number of
  /// runs.
  std::string sweep_of(const std::string& job_id) const;
  /// Those that are not over, and `unread` ones: their jobs are not to be removed.
  std::set<std::string> unfinished() const;
  bool is_unfinished(const std::string& id) const;

  std::filesystem::path dir(const std::string& id) const { return data_.sweeps() / id; }
  /// The folder of a sweep with its plan; recently used ones are cached. Throws what
  /// SweepFolder() throws.
  std::shared_ptr<const SweepFolder> open(const std::string& id);

  /// A new sweep, once its folder is complete on disk. `state` says its key, if it has one. Throws
  /// std::system_error.
  SweepEntryPtr create(const SweepSpec& spec, SweepPlan plan, SweepState state) {
    return create(spec, std::move(plan), std::move(state), [](const std::string&) {});
  }
  /// The same; `before` gets its id before its folder is made, which is not if it throws.
  SweepEntryPtr create(const SweepSpec& spec, SweepPlan plan, SweepState state,
                       const std::function<void(const std::string& id)>& before);
  /// The same of an id that create() has given to `before`; the sweep, if it is there by now.
  SweepEntryPtr create_again(const std::string& id, const SweepSpec& spec, SweepPlan plan);
  /// Where it stands now: on disk first. Throws std::system_error.
  void set_stage(const std::string& id, SweepStage stage);
  /// Marks a sweep that cannot continue as failed, in memory only.
  void give_up(const std::string& id, const std::string& error);
  /// Removes its folder, but none of its jobs. Throws std::system_error.
  void remove(const std::string& id);

 private:
  using FolderPtr = std::shared_ptr<const SweepFolder>;
  bool is_taken(const std::string& id, std::size_t runs) const;
  SweepEntryPtr make(const std::string& id, const SweepSpec& spec, SweepPlan plan,
                     SweepState state);
  void keep(const FolderPtr& folder);

  const DataRoot data_;
  std::mutex creating_;       // held while a sweep is made: no two choose the same ids
  mutable std::mutex mutex_;  // guards all below
  std::map<std::string, SweepEntryPtr> sweeps_;
  std::list<FolderPtr> opened_;  // the latest first
};

}  // namespace lacuna
