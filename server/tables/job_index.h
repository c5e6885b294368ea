#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "jobs/store/job_folder.h"

namespace lacuna {

struct JobEntry;

/// Nanoseconds of the clock of the file system that has `folder`, which may be another machine's.
/// Throws std::system_error if no file can be made there.
std::int64_t file_system_time(const std::filesystem::path& folder);

/// A number that changes with each change of the job's folder: of the folder itself, job.json,
/// state.json and queue.json, by their inodes, sizes and times of change (ctime, which no program
/// can set). 0, which stands for no such number: a file of these is missing where there has to be
/// one, or one has changed at `settled_before` or later, on the file system's clock. That must be
/// so long ago that a change after this call gets another time.
std::uint64_t folder_stamp(const JobFolder& folder, std::int64_t settled_before);

/// The index of jobs that are over: what a start of the service would read from their folders,
/// each with the stamp that its folder had. It is only ever a copy: an entry counts if its folder
/// still has that stamp, and a missing, damaged or older index costs time.
///
/// Layout: a header that tells this program's version and layout; for each entry the length and
/// the XXH3 of its bytes, and these.
class JobIndexReader {
 public:
  /// Without a usable file it has no entries.
  explicit JobIndexReader(const std::filesystem::path& file);

  /// The next entries, some dozens; none: that was all, or the rest is damaged. Thread-safe.
  std::vector<std::shared_ptr<JobEntry>> next();

 private:
  std::mutex mutex_;  // guards all below
  std::vector<char> buffer_;
  std::ifstream in_;
};

/// Replaces the index by these entries, all with a stamp. An index that is lost in a power cut
/// costs only time: it is not synced. Throws std::system_error.
void write_job_index(const std::filesystem::path& file,
                     const std::vector<std::shared_ptr<const JobEntry>>& entries);

}  // namespace lacuna
