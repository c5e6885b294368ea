#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/settings/field.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// slurm.json: one submission of a job, or of runs of a sweep as an array, to Slurm. It is written
/// before sbatch is called, so that the submission can be found by name after a crash; its batch
/// script renders only while this file names it, so that of two submissions at most one renders.
struct Submission {
  std::string name;      ///< of the Slurm job; no other submission has it
  std::int64_t job = 0;  ///< Slurm's number; 0: not known yet
  std::string made;      ///< UTC, ISO 8601
  bool operator==(const Submission&) const = default;
};
template <class V>
void describe(V& v, Submission& s) {
  v("name", s.name, {.doc = "of the Slurm job", .min = 1, .max = 128, .required = true});
  v("job", s.job, {.doc = "Slurm's number; 0: not known yet", .min = 0});
  v("made", s.made, {.doc = "UTC, ISO 8601"});
}

/// "lacuna-" + the name of the job's or sweep's folder, in plain characters + random characters.
std::string new_submission_name(const JobFolder& folder);

/// None if there is no submission. Throws std::system_error, and std::runtime_error if it is
/// corrupt.
std::optional<Submission> read_submission(const JobFolder& folder);
void write_submission(const JobFolder& folder, const Submission& submission);  ///< synced
bool has_submission(const JobFolder& folder);

/// The renderer's exit code that the batch script of this submission has written; as in shells, 128
/// + the signal that ended it. None: its renderer has not ended, or the script could not write it.
std::optional<int> read_submission_exit(const JobFolder& folder, const std::string& name);

/// From here on no submission of the job that has not begun will render. Throws std::system_error.
void forget_submission(const JobFolder& folder);

}  // namespace lacuna
