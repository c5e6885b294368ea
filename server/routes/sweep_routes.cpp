#include "server/routes/sweep_routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "jobs/spec/job_json.h"
#include "jobs/sweep/answers.h"
#include "server/http/conditional.h"
#include "server/routes/apply_change.h"
#include "server/routes/sweep_catalogue.h"

namespace lacuna {

SweepRoutes::SweepRoutes(const ScenesRoots& scenes, Store& store, SweepFolders& folders,
                         SweepKeeper& keeper)
    : store_(store), folders_(folders), keeper_(keeper), posting_(scenes, store, folders, keeper) {}

/// Throws HttpError 409 if its file cannot be read.
SweepFolders::FolderPtr SweepRoutes::open(const SweepEntry& sweep) {
  try {
    return folders_.open(sweep);
  } catch (const BadJob& bad) {
    throw HttpError(409, fmt::format("Sweep {}: {}.", sweep.id, bad.what()));
  }
}

Response SweepRoutes::list(const Request& request) const {
  OrderedJson list = OrderedJson::array();
  for (const SweepEntry& sweep : store_.sweeps()) list.push_back(to_json(sweep, store_));
  return with_tag(request, json_response(200, {{"sweeps", std::move(list)}}));
}

Response SweepRoutes::detail(const Request& request, const std::string& id) {
  const SweepEntry sweep = find_sweep(store_, id);
  const OrderedJson json =
      sweep.error.empty() ? sweep_detail(sweep, *open(sweep), store_) : to_json(sweep, store_);
  return with_tag(request, json_response(200, json));
}

Response SweepRoutes::cancel(const Request&, const std::string& id) {
  find_sweep(store_, id);
  apply([&] { keeper_.cancel(id); });
  const SweepEntry sweep = find_sweep(store_, id);
  return json_response(is_over(sweep.state) ? 200 : 202, to_json(sweep, store_));
}

Response SweepRoutes::remove(const Request&, const std::string& id) {
  find_sweep(store_, id);
  apply([&] { keeper_.remove(id); });
  Response response;
  response.status = 204;
  return response;
}

Response SweepRoutes::answers(const Request& request, const std::string& id) {
  return with_tag(request, json_response(200, answers_of(find_sweep(store_, id))));
}

std::string SweepRoutes::answers_of(const SweepEntry& sweep) {
  const std::int64_t change = store_.latest_change(sweep.id);
  const std::size_t runs = all_of(store_.run_counts(sweep.id));
  {
    const std::lock_guard lock(mutex_);
    for (const KnownAnswers& known : known_) {
      if (known.sweep == sweep.id && known.change == change && known.runs == runs)
        return known.text;
    }
  }
  const auto folder = open(sweep);
  const Answers answers = answer(*folder);
  std::string text = answers_text(*folder, answers);
  // A warning may concern a file that a person repairs.
  if (!is_over(sweep.state) || !answers.warnings.empty()) return text;
  constexpr std::size_t most = 4;
  const std::lock_guard lock(mutex_);
  known_.remove_if([&](const KnownAnswers& known) { return known.sweep == sweep.id; });
  known_.push_front({sweep.id, change, runs, text});
  if (known_.size() > most) known_.pop_back();
  return text;
}

Response SweepRoutes::table(const Request& request, const std::string& id) {
  Response response;
  response.content_type = "text/csv";
  response.headers = {{"Cache-Control", "no-cache"}};
  response.body = sweep_table(*open(find_sweep(store_, id)));
  return with_tag(request, std::move(response));
}

namespace {

RouteDoc sweep_post_doc() {
  return {.summary =
              "Queues a sweep: many jobs that differ in some settings; with an "
              "Idempotency-Key, once",
          .query = {{"dry_run", QueryParameter::Type::flag, "only check it and return its cells"}},
          .body_types = {"application/json"},
          .body_schema = sweep_schema(),
          .answers = {{201, "the sweep is stored; its runs become jobs, a few at a time"},
                      {200, "dry run; or the sweep created before with the same key"},
                      {400, "the sweep is not valid: `errors` lists every error"},
                      {422, "the key was used with another body"},
                      {507, "it could not be stored"}}};
}

}  // namespace

void SweepRoutes::add_to(Router& router) {
  add_collection(router);
  add_one(router);
  add_results(router);
}

void SweepRoutes::add_collection(Router& router) {
  using Parts = Router::Parts;
  router.add("GET", "/api/sweeps",
             {.summary = "Sweeps, newest first", .answers = {{200, "{sweeps}"}}},
             [this](const Request& request, const Parts&) { return list(request); });
  router.add("POST", "/api/sweeps", sweep_post_doc(), [this](const Request& request, const Parts&) {
    return request.query.flag("dry_run") ? posting_.dry_run(request) : posting_.post(request);
  });
  router.add("GET", "/api/schema/sweep", {.summary = "The JSON Schema of a sweep"},
             [](const Request& request, const Parts&) {
               return with_tag(request, json_response(200, sweep_schema()));
             });
}

void SweepRoutes::add_one(Router& router) {
  router.add("GET", "/api/sweeps/{id}",
             {.summary = "One sweep: its file, cells and runs",
              .answers = {{200,
                           "{id, label, state, created, finished, error, run_count, counts, "
                           "share, spec, cell_count, cells, runs}; only up to share if its folder "
                           "cannot be read"},
                          {404, "no such sweep"}}},
             with_id(*this, &SweepRoutes::detail));
  router.add("POST", "/api/sweeps/{id}/cancel",
             {.summary = "Cancels it and all its runs",
              .answers = {{200, "it is cancelled"},
                          {202, "renderers are stopping"},
                          {404, "no such sweep"},
                          {409, "it was already over"}}},
             with_id(*this, &SweepRoutes::cancel));
  router.add("DELETE", "/api/sweeps/{id}",
             {.summary = "Removes it, its runs' jobs and their results",
              .answers = {{204, "it is removed"},
                          {404, "no such sweep"},
                          {409,
                           "it is not over, or one of its jobs is not, or is the reference of an "
                           "unfinished job"}}},
             with_id(*this, &SweepRoutes::remove));
}

/// Adds the routes of results.
void SweepRoutes::add_results(Router& router) {
  router.add("GET", "/api/sweeps/{id}/answers",
             {.summary = "The comparison of its finished runs, with intervals",
              .answers = {{200, "the answers (docs/sweeps-and-reports.md)"},
                          {304, "not modified"},
                          {404, "no such sweep"}}},
             with_id(*this, &SweepRoutes::answers));
  router.add("GET", "/api/sweeps/{id}/table.csv",
             {.summary = "All curves as one table: a row for each run and instant",
              .answers = {{200, "the table; empty: no run has a curve yet"},
                          {304, "not modified"},
                          {404, "no such sweep"}}},
             with_id(*this, &SweepRoutes::table));
}

}  // namespace lacuna
