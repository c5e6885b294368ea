#include "server/routes/job_routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "jobs/spec/job_json.h"
#include "server/http/conditional.h"
#include "server/http/file_response.h"
#include "server/routes/apply_change.h"
#include "server/routes/catalogue.h"
#include "server/routes/json_body.h"

namespace lacuna {
namespace {

std::vector<State> states_of(const std::string& text) {
  std::vector<State> states;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view word = std::string_view(text).substr(begin, end - begin);
    const auto& values = EnumTable<State>::values;
    const auto found = std::find_if(values.begin(), values.end(),
                                    [&](const auto& value) { return value.name == word; });
    if (found == values.end()) {
      std::string names;
      for (const auto& value : values)
        names += fmt::format("{}{}", names.empty() ? "" : ", ", value.name);
      throw HttpError(400,
                      fmt::format("Query parameter state: \"{}\" is none of {}.", word, names));
    }
    states.push_back(found->value);
    begin = end + 1;
  }
  return states;
}

constexpr std::int64_t max_page = 1000;

}  // namespace

JobRoutes::JobRoutes(const ScenesRoots& scenes, Store& store, Queue& queue, SweepKeeper& keeper)
    : store_(store), queue_(queue), posting_(scenes, store, queue, keeper), events_(store) {}

Response JobRoutes::list(const Request& request) {
  JobQuery query;
  if (const auto states = request.query.text("state")) query.states = states_of(*states);
  query.words = request.query.text("label").value_or("");
  if (const auto limit = request.query.integer("limit", 1, max_page)) {
    query.limit = static_cast<std::size_t>(*limit);
  }
  query.sweep = request.query.text("sweep");
  if (query.sweep && !query.sweep->empty() && !is_job_id(*query.sweep)) {
    throw HttpError(400, "Query parameter sweep takes a sweep's id; empty: jobs of no sweep.");
  }
  query.after = request.query.text("cursor").value_or("");
  try {
    return with_tag(request, json_response(200, list_json(store_.list(query))));
  } catch (const std::invalid_argument& error) {
    throw HttpError(400, fmt::format("Query parameter cursor: {}.", error.what()));
  }
}

Response JobRoutes::answer(const Request& request, int status, const std::string& id) {
  const JobEntry entry = find_job(store_, id);
  return with_tag(request, json_response(status, job_detail(queue_.folder(id), entry)),
                  std::to_string(entry.revision));
}

Response JobRoutes::detail(const Request& request, const std::string& id) {
  return answer(request, 200, id);
}

Response JobRoutes::change(const Request& request, const std::string& id) {
  find_job(store_, id);
  const auto asked = read_job_change(request);
  apply([&] { queue_.change(id, asked.priority, asked.held, wanted_revision(request)); });
  return answer(request, 200, id);
}

Response JobRoutes::cancel(const Request& request, const std::string& id) {
  find_job(store_, id);
  apply([&] { queue_.cancel(id, wanted_revision(request)); });
  return answer(request, is_terminal(find_job(store_, id).state.state) ? 200 : 202, id);
}

Response JobRoutes::retry(const Request& request, const std::string& id) {
  find_job(store_, id);
  apply([&] { queue_.retry(id, wanted_revision(request)); });
  return answer(request, 200, id);
}

Response JobRoutes::extend(const Request& request, const std::string& id) {
  find_job(store_, id);
  const Budget budget = read_extension(request);
  apply([&] { queue_.extend(id, budget, wanted_revision(request)); });
  return answer(request, 200, id);
}

Response JobRoutes::remove(const Request& request, const std::string& id) {
  find_job(store_, id);
  apply([&] { queue_.remove(id, wanted_revision(request)); });
  Response response;
  response.status = 204;
  return response;
}

Response JobRoutes::file(const Request& request, const std::string& id, const std::string& name) {
  find_job(store_, id);
  for (const FileInfo& info : job_files()) {
    if (info.served && info.name == name) {
      return file_response(request, queue_.folder(id).dir(), name, info.media_type);
    }
  }
  if (name == "state.json") {  // of version 0.1
    throw HttpError(410, "The state is part of /api/jobs/ID; the end is in outcome.json.");
  }
  throw HttpError(404, fmt::format("Jobs have no file \"{}\".", name));
}

Response JobRoutes::log(const Request& request, const std::string& id) {
  find_job(store_, id);
  return log_response(queue_.folder(id).dir(), "log.txt",
                      request.query.integer("offset", 0).value_or(0));
}

namespace {

using QueryType = QueryParameter::Type;

RouteDoc list_doc() {
  return {.summary = "Jobs, newest first, by pages",
          .query = {{"state", QueryType::text, "any of these states, separated by commas"},
                    {"label", QueryType::text, "words in label, scene, integrator or id"},
                    {"sweep", QueryType::text, "the runs of this sweep; empty: jobs of no sweep"},
                    {"limit", QueryType::integer,
                     fmt::format("jobs on a page; default {}", JobQuery{}.limit), 1, max_page},
                    {"cursor", QueryType::text, "`next` of the previous page"}},
          .answers = {{200, "{jobs, total, counts, next, last_event}"}, {304, "not modified"}}};
}

RouteDoc post_doc() {
  return {.summary = "Queues a job; with an Idempotency-Key, once",
          .query = {{"dry_run", QueryType::flag, "only check it and fill in its defaults"}},
          .body_types = {"application/json"},
          .body_schema = job_schema(),
          .answers = {{201, "the job is stored and queued"},
                      {200, "dry run; or the job created before with the same key"},
                      {400, "the job is not valid: `errors` lists every error"},
                      {422, "the key was used with another body"},
                      {429, "too many jobs"},
                      {507, "it could not be stored"}}};
}

/// The description of a route that changes a job.
RouteDoc change_doc(std::string summary, std::string conflict, std::string body_schema = {}) {
  RouteDoc doc{.summary = std::move(summary)};
  if (!body_schema.empty()) doc.body_types = {"application/json"};
  doc.body_schema = std::move(body_schema);
  doc.answers = {{200, "the changed job"},
                 {404, "no such job"},
                 {409, std::move(conflict)},
                 {412, "the job changed since the ETag of If-Match"}};
  return doc;
}

Response event_stream(Events::Stream texts) {
  Response response;
  response.content_type = "text/event-stream";
  response.headers = {{"Cache-Control", "no-store"}};
  response.stream = std::move(texts);
  return response;
}

}  // namespace

void JobRoutes::add_to(Router& router) {
  add_collection(router);
  add_changes(router);
  add_results(router);
}

void JobRoutes::add_collection(Router& router) {
  using Parts = Router::Parts;
  router.add("GET", "/api/jobs", list_doc(),
             [this](const Request& request, const Parts&) { return list(request); });
  router.add("POST", "/api/jobs", post_doc(), [this](const Request& request, const Parts&) {
    return request.query.flag("dry_run") ? posting_.dry_run(request) : posting_.post(request);
  });
  router.add("GET", "/api/events",
             {.summary = "Changes of all jobs, as server-sent events: job, removed, reset",
              .query = {{"after", QueryType::text, "the list's last_event, or Last-Event-ID"}}},
             [this](const Request& request, const Parts&) {
               const auto last = request.header("last-event-id");
               return event_stream(events_.all(last ? last : request.query.text("after")));
             });
}

void JobRoutes::add_changes(Router& router) {
  router.add(
      "PATCH", "/api/jobs/{id}",
      change_doc("Changes its priority; holds or releases it", "it is over", job_change_schema()),
      with_id(*this, &JobRoutes::change));
  auto cancel = change_doc("Cancels it", "it was already over");
  cancel.answers.emplace_back(202, "its renderer is stopping");
  router.add("POST", "/api/jobs/{id}/cancel", std::move(cancel),
             with_id(*this, &JobRoutes::cancel));
  router.add("POST", "/api/jobs/{id}/retry",
             change_doc("Continues it from its checkpoint", "it has not failed or been cancelled"),
             with_id(*this, &JobRoutes::retry));
  router.add("POST", "/api/jobs/{id}/extend",
             change_doc("Continues it with a larger budget", "it is not over", extension_schema()),
             with_id(*this, &JobRoutes::extend));
  router.add("DELETE", "/api/jobs/{id}",
             {.summary = "Removes it and its results",
              .answers = {{204, "it is removed"},
                          {409,
                           "it is not over, or is the reference of an unfinished job, or a run of "
                           "an unfinished sweep"},
                          {412, "the job changed since the ETag of If-Match"}}},
             with_id(*this, &JobRoutes::remove));
}

void JobRoutes::add_results(Router& router) {
  using Parts = Router::Parts;
  router.add("GET", "/api/jobs/{id}", {.summary = "One job"}, with_id(*this, &JobRoutes::detail));
  router.add("GET", "/api/jobs/{id}/log",
             {.summary = "Its log from a byte offset on; header Next-Offset has the next offset",
              .query = {{"offset", QueryType::integer, "bytes to skip", 0, INT64_MAX}}},
             with_id(*this, &JobRoutes::log));
  router.add("GET", "/api/jobs/{id}/events",
             {.summary = "Its state and progress as server-sent events, until it is over"},
             [this](const Request& request, const Parts& parts) {
               const JobEntry entry = find_job(store_, parts[0]);
               return event_stream(events_.job(entry.id, request.header("last-event-id")));
             });
  router.add("GET", "/api/jobs/{id}/files/{name}",
             {.summary = "A result; supports ETag, If-None-Match, Range and If-Range",
              .query = {{"v", QueryType::text, "any text, to bypass caches"}}},
             [this](const Request& request, const Parts& parts) {
               return file(request, parts[0], parts[1]);
             });
}

}  // namespace lacuna
