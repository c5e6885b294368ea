#include "server/routes.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "jobs/spec/job_json.h"
#include "server/file_response.h"

namespace lacuna {
namespace {

Response json_response(int status, const Json& json) {
  Response response;
  response.status = status;
  response.content_type = "application/json";
  response.headers = {{"Cache-Control", "no-store"}};
  response.body = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  return response;
}

/// "application/json; charset=utf-8" and the like.
bool is_json(std::string type) {
  type = type.substr(0, type.find(';'));
  type.erase(type.find_last_not_of(" \t") + 1);
  std::transform(type.begin(), type.end(), type.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return type == "application/json";
}

JobSpec parse(const std::string& body) {
  try {
    return parse_job(body);
  } catch (const BadJob& bad) {
    throw HttpError(400, "The job is not valid.", bad.problems());
  }
}

/// A new job on disk.
JobFolder store(const DataRoot& data, const JobSpec& spec) {
  try {
    return JobFolder::create(data.jobs() / new_job_id(), spec);
  } catch (const std::system_error& error) {
    spdlog::error("a job could not be stored: {}", error.what());
    throw HttpError(507, fmt::format("The job could not be stored: {}.", error.code().message()));
  }
}

}  // namespace

Routes::Routes(DataRoot data, ScenesRoots scenes, Queue& queue, StaticFiles page)
    : data_(std::move(data)),
      scenes_(std::move(scenes)),
      queue_(queue),
      page_(std::move(page)),
      catalogue_(data_, queue),
      events_(queue) {
  using Parts = Router::Parts;
  router_.add("GET", "/health", [](const Request&, const Parts&) {
    return json_response(200, {{"status", "ok"}});
  });
  router_.add("GET", "/api/jobs", [this](const Request&, const Parts&) {
    return json_response(200, catalogue_.list());
  });
  router_.add("POST", "/api/jobs",
              [this](const Request& request, const Parts&) { return post_job(request); });
  router_.add("GET", "/api/jobs/{}", [this](const Request&, const Parts& parts) {
    return json_response(200, catalogue_.detail(catalogue_.find(parts[0])));
  });
  router_.add("POST", "/api/jobs/{}/cancel",
              [this](const Request&, const Parts& parts) { return cancel_job(parts[0]); });
  router_.add("GET", "/api/jobs/{}/events", [this](const Request&, const Parts& parts) {
    Response response;
    response.content_type = "text/event-stream";
    response.headers = {{"Cache-Control", "no-store"}};
    response.stream = events_.open(catalogue_.find(parts[0]));
    return response;
  });
  // The page gives each version of a file an address of its own.
  const RouteDoc versioned{.query = {{.name = "v", .doc = "Any text; has no effect."}}};
  router_.add("GET", "/api/jobs/{}/files/{}", versioned,
              [this](const Request& request, const Parts& parts) {
                return job_file(request, parts[0], parts[1]);
              });
  router_.add("GET", "/api/schema/job", [](const Request&, const Parts&) {
    return json_response(200, Json::parse(job_schema()));
  });
  router_.add("GET", "/api/scenes", [this](const Request&, const Parts&) {
    return json_response(200, {{"scenes", scenes_.list()}});
  });
}

Response Routes::handle(const Request& request) const {
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (reads && page_.has(request.path)) return page_.get(request);
  return router_.route(request);
}

Response Routes::post_job(const Request& request) const {
  if (!is_json(request.header("content-type").value_or(""))) {
    throw HttpError(415, "A job is posted with Content-Type: application/json.");
  }
  const JobSpec spec = parse(request.read_body(max_job_bytes));
  check_files(spec);
  const JobFolder folder = store(data_, spec);
  queue_.add(folder);
  spdlog::info("{}: queued ({})", folder.id(), spec.scene);
  Response response = json_response(201, catalogue_.detail(folder));
  response.headers.emplace_back("Location", "/api/jobs/" + folder.id());
  return response;
}

/// What the job names must be there before it is taken.
void Routes::check_files(const JobSpec& spec) const {
  std::vector<Problem> problems;
  const auto check = [&](const std::string& name, const std::vector<std::string_view>& extensions,
                         const char* pointer) {
    try {
      scenes_.resolve(name, extensions);
    } catch (const std::invalid_argument& error) {
      problems.push_back({pointer, error.what()});
    }
  };
  check(spec.scene, {".glb", ".gltf"}, "/scene");
  if (spec.environment) check(spec.environment->file, {".exr", ".hdr"}, "/environment/file");
  if (!problems.empty()) throw HttpError(400, "The job names a file that is not there.", problems);
}

Response Routes::cancel_job(const std::string& id) const {
  const JobFolder folder = catalogue_.find(id);
  const Queue::Cancel result = queue_.cancel(folder);
  const JobState state = queue_.state(folder);
  const bool over = result == Queue::Cancel::over || is_terminal(state.state);
  if (over && state.state != State::cancelled) {
    throw HttpError(409, fmt::format("The job is {}.", enum_name(state.state)));
  }
  return json_response(is_terminal(state.state) ? 200 : 202, catalogue_.detail(folder));
}

Response Routes::job_file(const Request& request, const std::string& id,
                          const std::string& name) const {
  const JobFolder folder = catalogue_.find(id);
  for (const FileInfo& info : job_files()) {
    if (info.served && info.name == name) {
      return file_response(request, folder.dir(), name, info.media_type);
    }
  }
  throw HttpError(404, fmt::format("Jobs have no file \"{}\".", name));
}

}  // namespace lacuna
