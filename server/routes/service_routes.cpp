#include "server/routes/service_routes.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "base/storage/available_memory.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/version.h"
#include "jobs/store/machine.h"
#include "server/http/conditional.h"
#include "server/http/prometheus.h"
#include "server/routes/cache_listing.h"

namespace lacuna {
namespace {

constexpr std::uint64_t max_scene_bytes = std::uint64_t{256} << 20;

/// The state machine as JSON.
OrderedJson states() {
  OrderedJson states = OrderedJson::array(), transitions = OrderedJson::array();
  for (const auto& [state, name, doc] : EnumTable<State>::values) {
    states.push_back({{"name", name},
                      {"doc", doc},
                      {"terminal", is_terminal(state)},
                      {"actions", allowed_actions(state)}});
  }
  for (const Transition& t : state_transitions()) {
    transitions.push_back(
        {{"from", enum_name(t.from)}, {"to", enum_name(t.to)}, {"by", t.by}, {"when", t.why}});
  }
  return {{"states", std::move(states)}, {"transitions", std::move(transitions)}};
}

double cpu_seconds(int who) {
  rusage usage{};
  ::getrusage(who, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

Response ServiceRoutes::health() const {
  const std::string obstacle = facts_.queue.obstacle();
  if (obstacle.empty()) return json_response(200, {{"status", "ok"}});
  return json_response(200, {{"status", "waiting"}, {"obstacle", obstacle}});
}

Response ServiceRoutes::info() const {
  const DiskRoom room = facts_.disk.room();
  const ServiceSettings& s = facts_.settings;
  const auto counts = facts_.store.counts();
  const std::chrono::duration<double> up = std::chrono::steady_clock::now() - start_;
  return json_response(200, {{"version", version()},
                             {"started", started_},
                             {"uptime_seconds", up.count()},
                             {"uploads", facts_.uploads != nullptr},
                             {"settings",
                              {{"executor", s.executor == ExecutorKind::slurm ? "slurm" : "local"},
                               {"jobs", s.queue.children},
                               {"max_attempts", s.queue.max_attempts},
                               {"max_jobs", s.queue.max_waiting},
                               {"grace_seconds", s.grace_seconds},
                               {"memory_limit", s.limits.memory_bytes},
                               {"nice", s.limits.niceness},
                               {"keep_jobs", s.care.keep_jobs},
                               {"keep_days", s.care.keep_days}}},
                             {"machine",
                              {{"cpu", processor_name()},
                               {"cores", processor_threads()},
                               {"memory_bytes", memory_bytes()}}},
                             {"disk",
                              {{"free_bytes", room.bytes},
                               {"floor_bytes", facts_.disk.floor()},
                               {"free_inodes", room.inodes}}},
                             {"queue",
                              {{"queued", counts.at(State::queued)},
                               {"running", counts.at(State::running)},
                               {"held", counts.at(State::held)}}}});
}

Response ServiceRoutes::metrics() const {
  PrometheusText text;
  auto& jobs = text.gauge("lacuna_jobs", "Jobs, by state.");
  for (const auto& [state, n] : facts_.store.counts()) {
    jobs.value(static_cast<double>(n), {{"state", std::string(enum_name(state))}});
  }
  const DiskRoom room = facts_.disk.room();
  text.gauge("lacuna_disk_free_bytes", "Free space on the disk of the jobs.")
      .value(static_cast<double>(room.bytes));
  text.gauge("lacuna_disk_free_inodes", "Free inodes on the disk of the jobs.")
      .value(static_cast<double>(room.inodes));
  text.gauge("lacuna_waiting", "1: a transient obstacle keeps jobs waiting.")
      .value(facts_.queue.obstacle().empty() ? 0 : 1);
  text.gauge("lacuna_disk_floor_bytes", "Free disk space below which jobs wait.")
      .value(static_cast<double>(facts_.disk.floor()));
  text.counter("lacuna_events_total", "Number of the latest event of jobs.")
      .value(static_cast<double>(facts_.store.journal().last()));
  text.counter("lacuna_cpu_seconds_total", "CPU time, of the service and of renderers that ended.")
      .value(cpu_seconds(RUSAGE_SELF), {{"of", "service"}})
      .value(cpu_seconds(RUSAGE_CHILDREN), {{"of", "renderers"}});
  write_metrics(text, facts_.http);
  Response response;
  response.content_type = std::string(PrometheusText::media_type);
  response.headers = {{"Cache-Control", "no-store"}};
  response.body = text.text();
  return response;
}

Response ServiceRoutes::put_scene(const Request& request, const std::string& name) const {
  if (facts_.uploads == nullptr) {
    throw HttpError(404, "This service accepts no scenes: it runs without --uploads.");
  }
  if (!is_upload_name(name)) {
    const std::string sent = request.path.substr(request.path.rfind('/') + 1);
    throw HttpError(400,
                    fmt::format("A scene cannot be named \"{}\"; {}.", sent, upload_name_rule));
  }
  const char* type = name.ends_with(".zip") ? "application/zip" : "model/gltf-binary";
  if (media_type(request) != type) {
    throw HttpError(415, fmt::format("\"{}\" is sent with Content-Type: {}.", name, type));
  }
  SceneUploads::Draft draft = facts_.uploads->begin();
  request.read_body_to(draft.fd(), max_scene_bytes);
  const SceneUploads::Result result = facts_.uploads->publish(std::move(draft), name);
  using Outcome = SceneUploads::Outcome;
  switch (result.outcome) {
    case Outcome::created:
      return json_response(201, {{"scene", result.scene}, {"bytes", result.bytes}});
    case Outcome::same:
      return json_response(200, {{"scene", result.scene}, {"bytes", result.bytes}});
    case Outcome::conflict:
      throw HttpError(
          409,
          fmt::format("Another scene has the name \"{}\", here or in a preceding folder.", name));
    case Outcome::busy:
      throw HttpError(503, result.reason).with("Retry-After", "2");
    case Outcome::refused:
      break;
  }
  throw HttpError(422, result.reason);
}

void ServiceRoutes::add_to(Router& router) {
  using Parts = Router::Parts;
  router.add(
      "GET", "/health",
      {.summary = "The service is up",
       .answers =
           {{200,
             "{\"status\": \"ok\"}, or \"waiting\" with the \"obstacle\" for which jobs wait"}},
       .needs_token = false},
      [this](const Request&, const Parts&) { return health(); });
  router.add("GET", "/metrics", {.summary = "Metrics, for Prometheus"},
             [this](const Request&, const Parts&) { return metrics(); });
  router.add("GET", "/api/info", {.summary = "Version, settings, machine, free disk space"},
             [this](const Request&, const Parts&) { return info(); });
  router.add("GET", "/openapi.json", {.summary = "This description"},
             [&router](const Request& request, const Parts&) {
               const OrderedJson info = {{"title", "Lacuna"}, {"version", version()}};
               return with_tag(request, json_response(200, router.openapi(info)));
             });
  router.add("GET", "/api/states",
             {.summary = "The states of a job, what may be done in each, and the allowed changes"},
             [](const Request& request, const Parts&) {
               return with_tag(request, json_response(200, states()));
             });
  router.add("GET", "/api/schema/job", {.summary = "The JSON Schema of a job"},
             [](const Request& request, const Parts&) {
               return with_tag(request, json_response(200, job_schema()));
             });
  router.add("GET", "/api/scenes", {.summary = "The scenes that jobs can name"},
             [this](const Request&, const Parts&) {
               return json_response(200, {{"scenes", facts_.scenes.list()}});
             });
  router.add(
      "PUT", "/api/scenes/{name}",
      {.summary =
           "Stores a scene (NAME.glb), or the folder of one (NAME.zip, application/zip, with "
           "scene.glb and what it refers to), if it can be rendered; never replaces one",
       .body_types = {"model/gltf-binary", "application/zip"},
       .answers = {{201, "it is stored"},
                   {200, "the same bytes were stored already"},
                   {400, upload_name_rule},
                   {404, "the service runs without --uploads"},
                   {409, "another scene has that name, here or in a preceding scenes folder"},
                   {413, "it is larger than 256 MiB"},
                   {422, "it is not a valid scene"},
                   {503, "it cannot be checked now"}},
       .any_characters = true},
      [this](const Request& request, const Parts& parts) { return put_scene(request, parts[0]); });
  router.add("GET", "/api/cache", {.summary = "The cached references and artefacts"},
             [this](const Request&, const Parts&) {
               return json_response(200, cache_listing(facts_.data));
             });
}

}  // namespace lacuna
