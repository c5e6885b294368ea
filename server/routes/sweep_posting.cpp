#include "server/routes/sweep_posting.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <system_error>

#include "server/http/conditional.h"
#include "server/routes/named_files.h"
#include "server/routes/sweep_catalogue.h"
#include "server/telemetry/log.h"

namespace lacuna {

SweepPosting::SweepPosting(const ScenesRoots& scenes, SweepTable& sweeps, const JobTable& jobs,
                           SweepKeeper& keeper)
    : Posting("sweep", "/api/sweeps/", max_sweep_bytes),
      scenes_(scenes),
      sweeps_(sweeps),
      jobs_(jobs),
      keeper_(keeper) {}

Response SweepPosting::dry_run(const Request& request) const {
  SweepSpec spec;
  const SweepPlan plan = checked_plan(read_body(request), spec);
  return json_response(200, plan_json(spec, plan));
}

SweepPlan SweepPosting::checked_plan(const std::string& body, SweepSpec& spec) const {
  try {
    spec = parse_sweep(body);
    NamedFiles files(scenes_);
    return expand(spec, [&](const JobSpec& job) { return files.missing(job); });
  } catch (const BadJob& bad) {
    throw HttpError(400, "The sweep is not valid.", bad.problems());
  }
}

std::string SweepPosting::make(const std::string& body, const Key& key) {
  SweepSpec spec;
  SweepPlan plan = checked_plan(body, spec);
  SweepState state;
  state.idempotency_key = key.name;
  state.body_hash = key.body_hash;
  try {
    const SweepEntryPtr sweep = sweeps_.create(spec, std::move(plan), std::move(state));
    log::info("{}: a sweep of {} runs", sweep->id, sweep->state.runs);
    keeper_.notice();
    return sweep->id;
  } catch (const std::system_error& error) {
    log::error("a sweep could not be stored: {}", error.what());
    throw storage_error(error, "The sweep could not be stored");
  }
}

Posting::StoredKeys SweepPosting::stored_keys() const {
  StoredKeys keys;
  for (const SweepEntryPtr& sweep : sweeps_.all()) {
    if (sweep->unread) keys.unread = fmt::format("{}: {}", sweep->id, sweep->error);
    if (!sweep->state.idempotency_key.empty()) keys.ids[sweep->state.idempotency_key] = sweep->id;
  }
  return keys;
}

std::optional<std::string> SweepPosting::body_hash(const std::string& id) const {
  const SweepEntryPtr sweep = sweeps_.find(id);
  if (!sweep) return std::nullopt;
  return sweep->state.body_hash;
}

OrderedJson SweepPosting::describe_made(const std::string& id) const {
  const SweepEntryPtr sweep = find_sweep(sweeps_, id);
  return sweep_detail(*sweep, *sweeps_.open(id), jobs_);
}

}  // namespace lacuna
