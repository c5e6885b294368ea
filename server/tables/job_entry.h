#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "jobs/store/job_folder.h"

namespace lacuna {

/// The data of one job that the service holds in memory.
struct JobEntry {
  std::string id, label, scene, integrator, reference;
  std::string sweep;  ///< that it is a run of; empty: none
  bool exclusive = false;
  std::uint64_t job_hash = 0;  ///< of job.json
  JobState state;
  JobControl control;
  std::optional<Progress> progress;
  bool pictured = false;    ///< image.png is there: the first comes after the first progress
  bool over = false;        ///< terminal, and the queue has nothing more to say about it
  bool damaged = false;     ///< its folder cannot be read; state.error says why
  bool unread = false;      ///< its folder cannot be read for now; `obstacle` says why
  std::string obstacle;     ///< what keeps it from going on, and may pass; empty: nothing
  std::string place;        ///< where its renderer runs or waits; empty: this machine, or nowhere
  std::uint64_t stamp = 0;  ///< of the folder that all this was read from (folder_stamp()); 0: none

  // Made by complete() from the above:
  std::string text;                 ///< as an element of the API's list, JSON
  std::uint64_t revision_hash = 0;  ///< changes with the job, its state and the requests for it
  std::string words;                ///< in lower case: what a search by words looks at

  /// As clients see it.
  std::string revision() const;
};
using EntryPtr = std::shared_ptr<const JobEntry>;

/// As JobEntry::words has it.
std::string lower_case(std::string text);

/// Makes what follows from the rest.
void complete(JobEntry& entry);

/// Takes over what the table holds of a job.json that says `spec`; `text` is that file's.
void take_spec(JobEntry& entry, const JobSpec& spec, const std::string& text);

/// Whether the job's image.png is there.
bool has_picture(const JobFolder& folder);

/// What a job's folder says, but complete(). A damaged folder tells what it can: its key still
/// counts. `settled_before`: as folder_stamp() has it; 0: the entry gets no stamp. Throws what may
/// pass (may_pass()).
std::shared_ptr<JobEntry> read_entry(const JobFolder& folder, std::int64_t settled_before = 0);

/// Of a folder that cannot be read for now.
std::shared_ptr<JobEntry> unread_entry(const std::string& id, const std::exception& error);

}  // namespace lacuna
