#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "jobs/plan/expand.h"
#include "jobs/store/job_folder.h"
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
  /// A new sweep of a service, complete on disk and synced. `id` is of new_sweep_id(), `plan` what
  /// expand() makes of `spec`. Throws std::system_error; std::invalid_argument if it is there.
  static SweepFolder create_served(const DataRoot& data, const std::string& id,
                                   const SweepSpec& spec, SweepPlan plan, const SweepState& state);
  /// Opens the folder of a sweep. Throws BadJob, std::system_error.
  explicit SweepFolder(const std::filesystem::path& dir);

  const std::filesystem::path& dir() const { return dir_; }
  const SweepSpec& spec() const { return spec_; }
  const SweepPlan& plan() const { return plan_; }
  /// Whether it is a service's.
  bool is_served() const { return served_; }
  std::string id() const { return dir_.filename().string(); }

  /// The id of the job of a service that is this run.
  std::string job_id(const SweepRun& run) const;
  /// The folder of a run, which may not be there yet.
  JobFolder folder(const SweepRun& run) const;
  /// The same, made if it is not there. Throws std::system_error.
  JobFolder make_folder(const SweepRun& run) const;
  /// Where a run stands; `queued` if its folder is not there. Throws what JobFolder::read_state()
  /// throws.
  JobState state(const SweepRun& run) const;

 private:
  SweepFolder(std::filesystem::path dir, const SweepSpec& spec);
  SweepFolder(std::filesystem::path dir, SweepSpec spec, SweepPlan plan);

  std::filesystem::path dir_;
  SweepSpec spec_;
  SweepPlan plan_;
  bool served_;
};

/// An id for a sweep of a service with so many runs: neither the sweep nor any of its runs is there
/// yet, and `is_taken` does not object.
std::string new_sweep_id(const DataRoot& data, std::size_t runs,
                         const std::function<bool(const std::string& id)>& is_taken);

/// What a sweep's folder says without its plan being made. Throws BadJob, std::system_error;
/// std::runtime_error if state.json is missing or corrupt.
SweepSpec read_sweep_spec(const std::filesystem::path& dir);
SweepState read_sweep_state(const std::filesystem::path& dir);
/// Synced.
void write_sweep_state(const std::filesystem::path& dir, const SweepState& state);

/// All curves of a sweep as one tidy table (CSV, RFC 4180): a row for each run and instant, with
/// the run's name, cell, baseline's cell (if any), replicate, seed, state and settings before the
/// columns of curve.csv.
std::string sweep_table(const SweepFolder& sweep);

}  // namespace lacuna
