#include "server/routes/job_posting.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <vector>

#include "jobs/plan/expand.h"
#include "jobs/plan/shard_sweep.h"
#include "jobs/spec/job_json.h"
#include "jobs/store/new_folder.h"
#include "server/http/conditional.h"
#include "server/routes/catalogue.h"
#include "server/routes/named_files.h"
#include "server/telemetry/log.h"

namespace lacuna {
namespace {

bool has_shards(const JobSpec& spec) { return spec.shards > 1 && spec.shard == 0; }

/// Throws BadJob: more than a sweep has runs, or than there are iterations to share.
void check_shards(const JobSpec& spec) {
  auto most = static_cast<std::int64_t>(max_sweep_runs);
  std::string reason = "runs of a sweep";
  if (spec.budget.iterations && most_shards(*spec.budget.iterations) < most) {
    most = most_shards(*spec.budget.iterations);
    reason = fmt::format("as {} iterations are dealt in pairs", *spec.budget.iterations);
  }
  if (!has_shards(spec) || spec.shards <= most) return;
  throw BadJob(
      {{"/shards", fmt::format("found {}; allowed: 1 to {}, {}", spec.shards, most, reason)}});
}

}  // namespace

JobPosting::JobPosting(DataRoot data, const ScenesRoots& scenes, JobTable& table, Queue& queue,
                       SweepTable& sweeps, SweepKeeper& keeper)
    : Posting("job", "/api/jobs/", max_job_bytes),
      data_(std::move(data)),
      scenes_(scenes),
      table_(table),
      queue_(queue),
      sweeps_(sweeps),
      keeper_(keeper) {}

Response JobPosting::dry_run(const Request& request) const {
  const JobSpec spec = checked_spec(read_body(request));
  return json_response(200,
                       {{"job", parse_own(write_job(spec))}, {"warnings", OrderedJson::array()}});
}

Posting::StoredKeys JobPosting::stored_keys() const {
  StoredKeys keys;
  for (const EntryPtr& job : table_.all()) {
    if (job->unread) keys.unread = fmt::format("{}: {}", job->id, job->obstacle);
    if (!job->control.idempotency_key.empty()) keys.ids[job->control.idempotency_key] = job->id;
  }
  return keys;
}

std::optional<std::string> JobPosting::body_hash(const std::string& id) const {
  const EntryPtr entry = table_.find(id);
  if (!entry) return std::nullopt;
  return entry->control.body_hash;
}

OrderedJson JobPosting::describe_made(const std::string& id) const {
  return job_detail(table_, *find_job(table_, id));
}

/// One that will not be that of a run of some sweep.
std::string JobPosting::new_id() const {
  for (;;) {
    std::string id = new_job_id();
    if (table_.sweeps().sweep_of(id).empty()) return id;
  }
}

/// The job's folder and, if it has shards, their sweep. In this order: a crash in between leaves a
/// job whose sweep the keeper makes. Throws std::system_error.
JobFolder JobPosting::create(const JobSpec& spec, JobControl control) {
  const auto place = [&] { return data_.jobs() / new_id(); };
  if (!has_shards(spec)) return JobFolder::create(place(), spec, control);
  const SweepSpec shards = shard_sweep(spec);
  std::optional<JobFolder> folder;
  try {
    sweeps_.create(shards, expand(shards), {}, [&](const std::string& sweep) {
      control.shards = sweep;
      auto dir = place();
      while (run_index(sweep, dir.filename().string())) dir = place();
      folder = JobFolder::create(dir, spec, control);
    });
  } catch (...) {
    if (!folder || take_folder_back(folder->dir())) throw;
  }
  return *folder;
}

std::string JobPosting::make(const std::string& body, const Key& key) {
  const JobSpec spec = checked_spec(body);
  JobControl control;
  control.idempotency_key = key.name;
  control.body_hash = key.body_hash;
  try {
    queue_.check_room();
  } catch (const Full& full) {
    throw HttpError(429, full.what()).with("Retry-After", "10");
  }
  const JobFolder folder = [&] {
    try {
      return create(spec, control);
    } catch (const std::system_error& error) {
      log::error("a job could not be stored: {}", error.what());
      throw storage_error(error, "The job could not be stored");
    }
  }();
  queue_.add(folder.id());
  keeper_.notice();
  log::info("{}: queued ({})", folder.id(), spec.scene);
  return folder.id();
}

/// What the job names must be there, too, before it is taken.
JobSpec JobPosting::checked_spec(const std::string& body) const {
  try {
    JobSpec spec = parse_job(body);
    check_shards(spec);
    const auto missing = NamedFiles(scenes_).missing(spec);
    if (missing.empty()) return spec;
    throw HttpError(400, "The job names a missing file.", missing);
  } catch (const BadJob& bad) {
    throw HttpError(400, "The job is not valid.", bad.problems());
  }
}

}  // namespace lacuna
