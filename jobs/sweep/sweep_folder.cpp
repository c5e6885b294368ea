#include "jobs/sweep/sweep_folder.h"

#include <fmt/format.h>

#include "analysis/storage/atomic_file.h"
#include "jobs/spec/described_json.h"
#include "jobs/store/new_folder.h"
#include "jobs/store/own_document.h"

namespace lacuna {
namespace fs = std::filesystem;
namespace {

constexpr const char* spec_file = "sweep.json";
constexpr const char* state_file = "state.json";
constexpr const char* runs_folder = "runs";

/// The runs of two sweeps are the same: where they are compared may change afterwards.
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
        {{"", fmt::format("{} is no sweep's folder: it has no {}", dir.string(), spec_file)}});
  }
  return parse_sweep(read_file(dir / spec_file, max_sweep_bytes));
}

SweepState read_sweep_state(const fs::path& dir) { return read_own<SweepState>(dir / state_file); }

void write_sweep_state(const fs::path& dir, const SweepState& state) {
  write_file_atomically(dir / state_file, write_document(state));
}

std::string new_sweep_id(const DataRoot& data, std::size_t runs,
                         const std::function<bool(const std::string& id)>& is_taken) {
  for (;;) {
    std::string id = new_job_id();
    bool taken = is_taken(id) || fs::exists(data.sweeps() / id);
    for (std::size_t i = 0; i < runs && !taken; ++i) {
      taken = fs::exists(data.jobs() / run_job_id(id, i));
    }
    if (!taken) return id;
  }
}

SweepFolder::SweepFolder(fs::path dir, SweepSpec spec, SweepPlan plan)
    : dir_(std::move(dir)),
      spec_(std::move(spec)),
      plan_(std::move(plan)),
      served_(lacuna::is_served(dir_)) {}

SweepFolder::SweepFolder(fs::path dir, const SweepSpec& spec)
    : SweepFolder(std::move(dir), spec, expand(spec)) {}

SweepFolder::SweepFolder(const fs::path& dir)
    : SweepFolder(folder_path(dir), read_sweep_spec(dir)) {}

SweepFolder SweepFolder::create_served(const DataRoot& data, const std::string& id,
                                       const SweepSpec& spec, SweepPlan plan,
                                       const SweepState& state) {
  const fs::path dir = data.sweeps() / id;
  create_folder_whole(dir, [&](const fs::path& draft) {
    write_file_atomically(draft / spec_file, write_document(spec));
    write_sweep_state(draft, state);
  });
  return {dir, spec, std::move(plan)};
}

SweepFolder SweepFolder::preview(const fs::path& dir, const SweepSpec& spec) {
  SweepFolder folder(folder_path(dir), spec);
  const bool occupied = fs::exists(dir) && !fs::is_empty(dir);  // first: another may make it now
  if (fs::exists(dir / spec_file)) {
    if (same_runs(read_sweep_spec(dir), spec)) return folder;
    throw BadJob({{"", fmt::format("{} holds another sweep; name another folder with --out",
                                   dir.string())}});
  }
  if (occupied) {
    throw BadJob({{"", fmt::format("{} is there already and is no sweep's folder", dir.string())}});
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

JobFolder SweepFolder::folder(const SweepRun& run) const {
  if (!served_) return JobFolder(dir_ / runs_folder / run.name);
  return JobFolder(dir_.parent_path().parent_path() / "jobs" / job_id(run));
}

JobFolder SweepFolder::make_folder(const SweepRun& run) const {
  JobFolder job = folder(run);
  if (fs::exists(job.file("job.json"))) return job;
  try {
    return JobFolder::create(job.dir(), plan_.job_of(run));
  } catch (const std::invalid_argument&) {
    return job;  // another process made it meanwhile
  }
}

JobState SweepFolder::state(const SweepRun& run) const {
  const JobFolder job = folder(run);
  return fs::exists(job.file("state.json")) ? job.read_state() : JobState{};
}

}  // namespace lacuna
