#include "server/routes/sweep_posting.h"

#include <nlohmann/json.hpp>
#include <system_error>

#include "base/log/log.h"
#include "jobs/spec/described_json.h"
#include "server/http/conditional.h"
#include "server/routes/json_body.h"
#include "server/routes/named_files.h"
#include "server/routes/refused_command.h"
#include "server/routes/sweep_catalogue.h"

namespace lacuna {

Response SweepPosting::dry_run(const Request& request) const {
  SweepSpec spec;
  const SweepPlan plan = checked_plan(read_json_body(request, max_sweep_bytes), spec);
  return json_response(200, plan_json(spec, plan));
}

SweepPlan SweepPosting::checked_plan(const std::string& body, SweepSpec& spec) const {
  try {
    spec = parse_sweep(body);
    NamedFiles files(scenes_);
    return expand(spec, [&](const JobSpec& job) {
      throw_if_any(refused_command(job));
      return files.missing(job);
    });
  } catch (const BadJob& bad) {
    throw HttpError(400, "The sweep is not valid.", bad.problems());
  }
}

Response SweepPosting::post(const Request& request) {
  const std::string body = read_json_body(request, max_sweep_bytes);
  const PostKey key = key_of(request, body);
  SweepSpec spec;
  SweepPlan plan = checked_plan(body, spec);
  SweepEntry sweep;
  sweep.runs = plan.runs.size();
  sweep.id = store_.free_sweep_id(sweep.runs);
  sweep.label = spec.label;
  sweep.created = utc_now();
  sweep.key = key.name;
  sweep.body_hash = key.body_hash;
  sweep.spec = write_document(spec);
  bool replayed = false;
  try {
    store_.change([&](StoreChange& c) {
      const auto known = key.name ? c.sweep_of_key(*key.name) : std::nullopt;
      replayed = is_replay(known, key, "sweep");
      if (replayed) {
        sweep = *known;
      } else {
        c.add(sweep);
      }
    });
  } catch (const std::system_error& error) {
    log::error("a sweep could not be stored: {}", error.what());
    throw storage_error(error, "The sweep could not be stored");
  }
  const auto folder = replayed ? folders_.open(sweep) : folders_.keep(sweep, spec, std::move(plan));
  if (!replayed) {
    log::info("{}: a sweep of {} runs", sweep.id, sweep.runs);
    keeper_.notice();
  }
  return created(replayed, "/api/sweeps/" + sweep.id, sweep_detail(sweep, *folder, store_));
}

}  // namespace lacuna
