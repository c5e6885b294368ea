#include "jobs/sweep/sweep_folder.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/storage/atomic_file.h"
#include "base/storage/passing_error.h"
#include "jobs/spec/described_json.h"
#include "jobs/store/new_folder.h"
#include "jobs/store/own_document.h"

namespace lacuna {
namespace fs = std::filesystem;
namespace {

constexpr const char* spec_file = "sweep.json";
constexpr const char* state_file = "state.json";
constexpr const char* runs_folder = "runs";

/// Whether two sweeps have the same runs; `compare_at` may change afterwards.
bool same_runs(SweepSpec a, const SweepSpec& b) {
  a.compare_at = b.compare_at;
  return a == b;
}

/// A sweep is a service's if it has no runs of its own.
bool is_served(const fs::path& dir) {
  return is_job_id(dir.filename().string()) && fs::exists(dir / spec_file) &&
         !fs::exists(dir / runs_folder);
}

}  // namespace

SweepSpec read_sweep_spec(const fs::path& dir) {
  if (!fs::exists(dir / spec_file)) {
    throw BadJob(
        {{"", fmt::format("{} is not a sweep's folder: it has no {}", dir.string(), spec_file)}});
  }
  return parse_sweep(read_file(dir / spec_file, max_sweep_bytes));
}

SweepState read_sweep_state(const fs::path& dir) {
  if (is_gone(dir / state_file)) return {};
  return read_own<SweepState>(dir / state_file);
}

void write_sweep_state(const fs::path& dir, const SweepState& state) {
  write_file_atomically(dir / state_file, write_document(state), false);
}

SweepFolder::SweepFolder(fs::path dir, SweepSpec spec, SweepPlan plan, bool served)
    : dir_(std::move(dir)), spec_(std::move(spec)), plan_(std::move(plan)), served_(served) {}

SweepFolder::SweepFolder(fs::path dir, const SweepSpec& spec)
    : SweepFolder(dir, spec, expand(spec), lacuna::is_served(dir)) {}

SweepFolder::SweepFolder(const fs::path& dir)
    : SweepFolder(folder_path(dir), read_sweep_spec(dir)) {}

SweepFolder SweepFolder::of_service(const DataRoot& data, const std::string& id, SweepSpec spec,
                                    SweepPlan plan) {
  const fs::path dir = data.sweeps() / id;
  if (!fs::exists(dir / spec_file)) {
    fs::create_directories(dir);
    write_file_atomically(dir / spec_file, write_document(spec), false);
  }
  return {dir, std::move(spec), std::move(plan), true};
}

SweepFolder SweepFolder::of_jobs(SweepPlan plan) {
  SweepSpec spec;
  for (const SweepRun& run : plan.runs) spec.seeds = std::max(spec.seeds, run.replicate + 1);
  return {"", std::move(spec), std::move(plan), false};
}

SweepFolder SweepFolder::preview(const fs::path& dir, const SweepSpec& spec) {
  SweepFolder folder(folder_path(dir), spec);
  const bool occupied =
      fs::exists(dir) && !fs::is_empty(dir);  // first: another process may create it now
  if (fs::exists(dir / spec_file)) {
    if (same_runs(read_sweep_spec(dir), spec)) return folder;
    throw BadJob({{"", fmt::format("{} contains another sweep; choose another folder with --out",
                                   dir.string())}});
  }
  if (occupied) {
    throw BadJob({{"", fmt::format("{} exists and is not a sweep's folder", dir.string())}});
  }
  return folder;
}

SweepFolder SweepFolder::create(const fs::path& dir, const SweepSpec& spec) {
  SweepFolder folder = preview(dir, spec);
  if (fs::exists(dir / spec_file)) {
    if (read_sweep_spec(dir) != spec) {
      write_file_atomically(dir / spec_file, write_document(spec));
    }
    return folder;
  }
  std::error_code not_empty;
  fs::remove(folder.dir(), not_empty);
  try {
    create_folder_whole(folder.dir(), [&](const fs::path& draft) {
      fs::create_directory(draft / runs_folder);
      write_file_atomically(draft / spec_file, write_document(spec));
    });
  } catch (const std::invalid_argument&) {
    return preview(dir, spec);  // another array task was first
  }
  return folder;
}

std::string SweepFolder::job_id(const SweepRun& run) const {
  const auto seeds = static_cast<std::size_t>(spec_.seeds);
  return run_job_id(id(), run.cell * seeds + static_cast<std::size_t>(run.replicate));
}

fs::path SweepFolder::runs_dir() const { return dir_ / runs_folder; }

JobFolder SweepFolder::folder(const SweepRun& run) const {
  if (!served_) return JobFolder(runs_dir() / run.name);  // an absolute name stands for itself
  return JobFolder(dir_.parent_path().parent_path() / "jobs" / job_id(run));
}

JobState SweepFolder::state(const SweepRun& run) const { return folder(run).read_state(); }

}  // namespace lacuna
