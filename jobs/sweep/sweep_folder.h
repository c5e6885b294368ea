#pragma once

#include <filesystem>
#include <string>

#include "jobs/store/job_folder.h"
#include "jobs/sweep/expand.h"
#include "jobs/sweep/sweep_state.h"

namespace lacuna {

/// A sweep on disk. From the command line: sweep.json (the file with every default), runs/NAME (a
/// job's folder each) and table.csv. Of a service: DATA/sweeps/ID with sweep.json and state.json;
/// its runs are jobs of the service, DATA/jobs/ID, whose ids follow from the sweep's.
class SweepFolder {
 public:
  /// Makes the folder, or opens it where this very sweep lies there; it takes over where its runs
  /// are to be compared. Throws BadJob: another sweep, or something else, is there; what expand()
  /// throws; std::system_error.
  static SweepFolder create(const std::filesystem::path& dir, const SweepSpec& spec);
  /// The same without touching the disk: what would be in the folder, if it is not there.
  static SweepFolder preview(const std::filesystem::path& dir, const SweepSpec& spec);
  /// A sweep of a service; its sweep.json is written where it is missing. `plan` is what expand()
  /// makes of `spec`. Throws std::system_error.
  static SweepFolder of_service(const DataRoot& data, const std::string& id, SweepSpec spec,
                                SweepPlan plan);
  /// Opens the folder of a sweep. Throws BadJob, std::system_error.
  explicit SweepFolder(const std::filesystem::path& dir);

  const std::filesystem::path& dir() const { return dir_; }
  const SweepSpec& spec() const { return spec_; }
  const SweepPlan& plan() const { return plan_; }
  /// Whether it is a service's.
  bool is_served() const { return served_; }
  std::string id() const { return dir_.filename().string(); }

  /// Where its runs lie, of a sweep from the command line.
  std::filesystem::path runs_dir() const;
  /// The id of the job of a service that is this run.
  std::string job_id(const SweepRun& run) const;
  /// The folder of a run, which may not be there yet.
  JobFolder folder(const SweepRun& run) const;
  /// Where a run stands; `queued` if its folder is not there. Throws what JobFolder::read_state()
  /// throws.
  JobState state(const SweepRun& run) const;

 private:
  SweepFolder(std::filesystem::path dir, const SweepSpec& spec);
  SweepFolder(std::filesystem::path dir, SweepSpec spec, SweepPlan plan, bool served);

  std::filesystem::path dir_;
  SweepSpec spec_;
  SweepPlan plan_;
  bool served_;
};

/// What a sweep's folder says without its plan being made. Throws BadJob, std::system_error.
SweepSpec read_sweep_spec(const std::filesystem::path& dir);
/// state.json of a service's sweep; a running one where there is none. Throws std::system_error;
/// std::runtime_error if it is corrupt. Not synced when written: the database has it too.
SweepState read_sweep_state(const std::filesystem::path& dir);
void write_sweep_state(const std::filesystem::path& dir, const SweepState& state);

/// All curves of a sweep as one tidy table (CSV, RFC 4180): a row for each run and instant, with
/// the run's name, cell, baseline's cell (if any), replicate, seed, state and settings before the
/// columns of curve.csv.
std::string sweep_table(const SweepFolder& sweep);

}  // namespace lacuna
