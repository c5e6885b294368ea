#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "jobs/queue/sweep_entry.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

/// The folders of a service's sweeps, with their plans; those that were used last are kept, so that
/// a page that looks at a sweep again and again does not have its plan made each time. Thread-safe.
class SweepFolders {
 public:
  using FolderPtr = std::shared_ptr<const SweepFolder>;
  explicit SweepFolders(DataRoot data) : data_(std::move(data)) {}

  /// Made where it is missing. Throws BadJob, std::system_error.
  FolderPtr open(const SweepEntry& sweep);
  /// The same of a new sweep whose plan is known.
  FolderPtr keep(const SweepEntry& sweep, const SweepSpec& spec, SweepPlan plan);
  /// Its folder says where the sweep stands, for people and should the database be lost. Does not
  /// throw.
  void note(const SweepEntry& sweep) const;
  /// Removes it, but none of its jobs. Throws std::system_error.
  void remove(const std::string& id);
  std::filesystem::path dir(const std::string& id) const { return data_.sweeps() / id; }

 private:
  const DataRoot data_;
  std::mutex mutex_;
  std::list<FolderPtr> opened_;  // the latest first; under the mutex
};

}  // namespace lacuna
