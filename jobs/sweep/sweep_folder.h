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
  /// Creates the folder, or opens it if it contains the same sweep, updating `compare_at`. Throws
  /// BadJob if it contains another sweep or something else; the exceptions of expand();
  /// std::system_error.
  static SweepFolder create(const std::filesystem::path& dir, const SweepSpec& spec);
  /// The same without writing to the disk.
  static SweepFolder preview(const std::filesystem::path& dir, const SweepSpec& spec);
  /// A sweep of a service; writes its sweep.json if it is missing. `plan`: expand() of `spec`.
  /// Throws std::system_error.
  static SweepFolder of_service(const DataRoot& data, const std::string& id, SweepSpec spec,
                                SweepPlan plan);
  /// Jobs anywhere, as if they were the runs of a sweep: the runs of `plan` have the absolute paths
  /// of their folders as names.
  static SweepFolder of_jobs(SweepPlan plan);
  /// Opens the folder of a sweep. Throws BadJob, std::system_error.
  explicit SweepFolder(const std::filesystem::path& dir);

  const std::filesystem::path& dir() const { return dir_; }
  const SweepSpec& spec() const { return spec_; }
  const SweepPlan& plan() const { return plan_; }
  /// Whether it is a sweep of a service.
  bool is_served() const { return served_; }
  std::string id() const { return dir_.filename().string(); }

  /// The parent folder of its runs, for a sweep from the command line.
  std::filesystem::path runs_dir() const;
  /// The id of this run's job in a service.
  std::string job_id(const SweepRun& run) const;
  /// The folder of a run, which may not exist yet.
  JobFolder folder(const SweepRun& run) const;
  /// The state of a run; `queued` if its folder is missing. Throws the exceptions of
  /// JobFolder::read_state().
  JobState state(const SweepRun& run) const;

 private:
  SweepFolder(std::filesystem::path dir, const SweepSpec& spec);
  SweepFolder(std::filesystem::path dir, SweepSpec spec, SweepPlan plan, bool served);

  std::filesystem::path dir_;
  SweepSpec spec_;
  SweepPlan plan_;
  bool served_;
};

/// sweep.json of a sweep's folder, without making the plan. Throws BadJob, std::system_error.
SweepSpec read_sweep_spec(const std::filesystem::path& dir);
/// state.json of a service's sweep; `running` if it is missing. Throws std::system_error;
/// std::runtime_error if it is corrupt. Writing does not sync: the database has it, too.
SweepState read_sweep_state(const std::filesystem::path& dir);
void write_sweep_state(const std::filesystem::path& dir, const SweepState& state);

/// All curves of a sweep as one tidy table (CSV, RFC 4180): a row for each run and instant, with
/// the run's name, cell, baseline's cell (if any), replicate, seed, state and settings before the
/// columns of curve.csv.
std::string sweep_table(const SweepFolder& sweep);
/// A field of a CSV file.
std::string csv_field(const std::string& text);

}  // namespace lacuna
