#include "server/routes/job_posting.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <vector>

#include "base/log/log.h"
#include "jobs/spec/described_json.h"
#include "jobs/spec/job_json.h"
#include "jobs/sweep/expand.h"
#include "jobs/sweep/shard_sweep.h"
#include "server/http/conditional.h"
#include "server/routes/catalogue.h"
#include "server/routes/json_body.h"
#include "server/routes/named_files.h"
#include "server/routes/refused_command.h"

namespace lacuna {
namespace {

bool has_shards(const JobSpec& spec) { return spec.shards > 1 && spec.shard == 0; }

/// Throws BadJob for more shards than runs of a sweep, or than the iterations allow.
void check_shards(const JobSpec& spec) {
  auto most = static_cast<std::int64_t>(max_sweep_runs);
  std::string reason = "runs of a sweep";
  if (spec.budget.iterations && most_shards(*spec.budget.iterations) < most) {
    most = most_shards(*spec.budget.iterations);
    reason = fmt::format("because {} iterations are distributed in pairs", *spec.budget.iterations);
  }
  if (!has_shards(spec) || spec.shards <= most) return;
  throw BadJob(
      {{"/shards", fmt::format("found {}; allowed: 1 to {}, {}", spec.shards, most, reason)}});
}

}  // namespace

Response JobPosting::dry_run(const Request& request) const {
  const JobSpec spec = checked_spec(read_json_body(request, max_job_bytes));
  return json_response(200,
                       {{"job", parse_own(write_job(spec))}, {"warnings", OrderedJson::array()}});
}

/// The sweep whose runs are the job's shards, if it has any.
std::optional<SweepEntry> JobPosting::sweep_of_shards(const JobSpec& spec) const {
  if (!has_shards(spec)) return std::nullopt;
  const SweepSpec shards = shard_sweep(spec);
  SweepEntry sweep;
  sweep.runs = expand(shards).runs.size();
  sweep.id = store_.free_sweep_id(sweep.runs);
  sweep.label = shards.label;
  sweep.created = utc_now();
  sweep.spec = write_document(shards);
  return sweep;
}

Response JobPosting::post(const Request& request) {
  const std::string body = read_json_body(request, max_job_bytes);
  const PostKey key = key_of(request, body);
  const JobSpec spec = checked_spec(body);
  JobEntry job;
  take_spec(job, spec);
  auto sweep = sweep_of_shards(spec);
  job.key = key.name;
  job.body_hash = key.body_hash;
  job.state.created = utc_now();
  if (sweep) job.shards = sweep->id;
  do {
    job.id = store_.free_job_id();
  } while (sweep && run_index(sweep->id, job.id).value_or(sweep->runs) < sweep->runs);
  bool replayed = false;
  try {
    store_.change([&](StoreChange& c) {
      const auto known = key.name ? c.job_of_key(*key.name) : std::nullopt;
      replayed = is_replay(known, key, "job");
      if (replayed) {
        job = *known;
        return;
      }
      queue_.check_room();
      if (sweep) c.add(*sweep);
      c.add(job);
    });
  } catch (const Full& full) {
    throw HttpError(429, full.what()).with("Retry-After", "10");
  } catch (const std::system_error& error) {
    log::error("a job could not be stored: {}", error.what());
    throw storage_error(error, "The job could not be stored");
  }
  if (!replayed) {
    queue_.take_up({job});
    keeper_.notice();
    log::info("{}: queued ({})", job.id, job.scene);
  }
  return created(replayed, "/api/jobs/" + job.id, job_detail(queue_.folder(job.id), job));
}

/// Also checks that the files of the job exist.
JobSpec JobPosting::checked_spec(const std::string& body) const {
  try {
    JobSpec spec = parse_job(body);
    check_shards(spec);
    throw_if_any(refused_command(spec));
    const auto missing = NamedFiles(scenes_).missing(spec);
    if (missing.empty()) return spec;
    throw HttpError(400, "The job names a missing file.", missing);
  } catch (const BadJob& bad) {
    throw HttpError(400, "The job is not valid.", bad.problems());
  }
}

}  // namespace lacuna
