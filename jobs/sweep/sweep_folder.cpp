#include "jobs/sweep/sweep_folder.h"

#include <fmt/format.h>

#include "analysis/storage/atomic_file.h"
#include "jobs/spec/described_json.h"
#include "jobs/store/new_folder.h"

namespace lacuna {
namespace fs = std::filesystem;
namespace {

constexpr const char* spec_file = "sweep.json";

SweepSpec read_spec(const fs::path& dir) {
  if (!fs::exists(dir / spec_file)) {
    throw BadJob(
        {{"", fmt::format("{} is no sweep's folder: it has no {}", dir.string(), spec_file)}});
  }
  return parse_sweep(read_file(dir / spec_file, max_sweep_bytes));
}

}  // namespace

SweepFolder::SweepFolder(fs::path dir, SweepSpec spec)
    : dir_(std::move(dir)), spec_(std::move(spec)), plan_(expand(spec_)) {}

SweepFolder::SweepFolder(const fs::path& dir)
    : SweepFolder(fs::absolute(dir).lexically_normal(), read_spec(dir)) {}

SweepFolder SweepFolder::preview(const fs::path& dir, const SweepSpec& spec) {
  SweepFolder folder(fs::absolute(dir).lexically_normal(), spec);
  const bool occupied = fs::exists(dir) && !fs::is_empty(dir);  // first: another may make it now
  if (fs::exists(dir / spec_file)) {
    if (read_spec(dir) == spec) return folder;
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
  if (fs::exists(dir / spec_file)) return folder;
  std::error_code not_empty;
  fs::remove(folder.dir(), not_empty);
  try {
    create_folder_whole(folder.dir(), [&](const fs::path& draft) {
      fs::create_directory(draft / "runs");
      write_file_atomically(draft / spec_file, write_document(spec));
    });
  } catch (const std::invalid_argument&) {
    return preview(dir, spec);  // another array task was first
  }
  return folder;
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
