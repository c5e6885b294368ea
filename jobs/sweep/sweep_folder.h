#pragma once

#include <filesystem>
#include <string>

#include "jobs/store/job_folder.h"
#include "jobs/sweep/expand.h"

namespace lacuna {

/// A sweep on disk: sweep.json (the file with every default), runs/NAME (a job's folder each) and
/// table.csv.
class SweepFolder {
 public:
  /// Makes the folder, or opens it where this very sweep lies there. Throws BadJob: another sweep,
  /// or something else, is there; what expand() throws; std::system_error.
  static SweepFolder create(const std::filesystem::path& dir, const SweepSpec& spec);
  /// The same without touching the disk: what would be in the folder, if it is not there.
  static SweepFolder preview(const std::filesystem::path& dir, const SweepSpec& spec);
  /// Opens the folder of a sweep. Throws BadJob, std::system_error.
  explicit SweepFolder(const std::filesystem::path& dir);

  const std::filesystem::path& dir() const { return dir_; }
  const SweepSpec& spec() const { return spec_; }
  const SweepPlan& plan() const { return plan_; }

  /// The folder of a run, which may not be there yet.
  JobFolder folder(const SweepRun& run) const { return JobFolder(dir_ / "runs" / run.name); }
  /// The same, made if it is not there. Throws std::system_error.
  JobFolder make_folder(const SweepRun& run) const;
  /// Where a run stands; `queued` if its folder is not there. Throws what JobFolder::read_state()
  /// throws.
  JobState state(const SweepRun& run) const;

 private:
  SweepFolder(std::filesystem::path dir, SweepSpec spec);

  std::filesystem::path dir_;
  SweepSpec spec_;
  SweepPlan plan_;
};

/// All curves of a sweep as one tidy table (CSV, RFC 4180): a row for each run and instant, with
/// the run's name, cell, baseline's cell (if any), replicate, seed, state and settings before the
/// columns of curve.csv.
std::string sweep_table(const SweepFolder& sweep);

}  // namespace lacuna
