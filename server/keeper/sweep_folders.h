#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "jobs/queue/sweep_entry.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

/// The folders of a service's sweeps, with their plans. Caches the most recently used ones, so that
/// a page that polls a sweep does not rebuild its plan each time. Thread-safe.
class SweepFolders {
 public:
  using FolderPtr = std::shared_ptr<const SweepFolder>;
  explicit SweepFolders(DataRoot data) : data_(std::move(data)) {}

  /// Opens the folder, or creates it if it is missing. Throws BadJob, std::system_error.
  FolderPtr open(const SweepEntry& sweep);
  /// The same for a new sweep whose plan is known.
  FolderPtr keep(const SweepEntry& sweep, const SweepSpec& spec, SweepPlan plan);
  /// Writes the sweep's state into its folder, for people and in case the database is lost. Does
  /// not throw.
  void note(const SweepEntry& sweep) const;
  /// Removes the folder, but none of its jobs. Throws std::system_error.
  void remove(const std::string& id);
  std::filesystem::path dir(const std::string& id) const { return data_.sweeps() / id; }

 private:
  const DataRoot data_;
  std::mutex mutex_;
  std::list<FolderPtr> opened_;  // latest first; guarded by the mutex
};

}  // namespace lacuna
