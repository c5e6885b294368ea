#include "server/routes/tool_routes.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "base/storage/atomic_file.h"
#include "jobs/queue/child_process.h"
#include "jobs/spec/figure_spec.h"
#include "jobs/spec/job_json.h"
#include "jobs/store/exit_code.h"
#include "server/http/conditional.h"
#include "server/routes/catalogue.h"
#include "server/routes/json_body.h"

namespace lacuna {
namespace {

constexpr std::chrono::seconds longest_run{120};
constexpr std::uint64_t most_output = 64 << 20;

/// A folder for the files of one run; the next start of a killed service removes it.
struct ScratchFolder {
  explicit ScratchFolder(const std::filesystem::path& parent)
      : dir(temporary_name(parent / "figure")) {
    std::filesystem::create_directory(dir);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(dir, ignored);
  }
  const std::filesystem::path dir;
};

/// The refusal for a run that has failed, with what the program has said, at most 4 KiB.
HttpError failure_of(const BoundedRun& run) {
  const int code = run.end.kind == Ending::Kind::exited ? run.end.code : -1;
  const bool passing = code == exit_memory || code == exit_interrupted || never_began(run.end);
  const int status = passing ? 503 : code == exit_bad_job ? 400 : code == exit_asset ? 409 : 500;
  constexpr std::string_view name = "lacuna: ";  // warnings may precede it
  const std::size_t begin = run.errors.find(name);
  if (begin == std::string::npos) return {status, run.end.reason};
  std::string text = run.errors.substr(begin + name.size(), 4096);
  while (text.ends_with('\n')) text.pop_back();
  return {status, text};
}

}  // namespace

ToolRoutes::ToolRoutes(ExecutorSettings tools, const Store& store)
    : tools_(std::move(tools)), environment_(child_environment(tools_)), store_(store) {}

/// The output of `lacuna` with these arguments. Throws HttpError.
std::string ToolRoutes::run(const std::vector<std::string>& arguments,
                            const std::filesystem::path& directory) {
  if (!free_.try_acquire()) {
    throw HttpError(503, "Two figures or traces are being made.").with("Retry-After", "5");
  }
  const auto give_back = [](std::counting_semaphore<2>* s) { s->release(); };
  const std::unique_ptr<std::counting_semaphore<2>, decltype(give_back)> held(&free_, give_back);
  Command command{.arguments = {tools_.renderer.string()},
                  .environment = environment_,
                  .directory = directory,
                  .limits = tools_.limits};
  command.arguments.insert(command.arguments.end(), arguments.begin(), arguments.end());
  command.limits.file_bytes = most_output;
  BoundedRun done;
  try {
    done = run_bounded(command, stop_.fd(), longest_run);
  } catch (const std::system_error& error) {
    throw HttpError(503, fmt::format("It could not be started: {}.", error.code().message()));
  }
  if (stop_.is_requested()) throw HttpError(503, "The service is shutting down.");
  if (!done.in_time) {
    throw HttpError(504, fmt::format("It took longer than {} s.", longest_run.count()));
  }
  if (done.end.kind != Ending::Kind::exited || done.end.code != exit_done) throw failure_of(done);
  return std::move(done.output);
}

Response ToolRoutes::figure(const Request& request) {
  static const std::map<std::string, std::string> types{
      {"pdf", "application/pdf"}, {"svg", "image/svg+xml"}, {"png", "image/png"}};
  const auto type = types.find(request.query.text("format").value_or("pdf"));
  if (type == types.end()) throw HttpError(400, "Query parameter format takes pdf, svg or png.");
  const std::string spec = read_json_body(request, max_figure_bytes);
  const ScratchFolder scratch(tools_.data / "sweeps");
  write_file_atomically(scratch.dir / "figure.json", spec, false);
  run({"figure", "figure.json", "--ids", "--out", "figure." + type->first}, scratch.dir);
  Response response;
  response.content_type = type->second;
  response.headers = {{"Cache-Control", "no-store"}};
  response.body = read_file(scratch.dir / ("figure." + type->first), most_output);
  return response;
}

Response ToolRoutes::trace(const Request& request, const std::string& id) {
  find_job(store_, id);
  const auto x = request.query.integer("x", 0), y = request.query.integer("y", 0);
  if (!x || !y) throw HttpError(400, "Query parameters x and y are required: the pixel.");
  std::vector<std::string> arguments{"trace", (tools_.data / "jobs" / id).string(), "--json",
                                     fmt::format("--pixel={},{}", *x, *y)};
  for (const char* name : {"samples", "brightest"}) {
    if (const auto n = request.query.integer(name, 1)) {
      arguments.push_back(fmt::format("--{}={}", name, *n));
    }
  }
  return json_response(200, run(arguments, tools_.directory));
}

void ToolRoutes::add_to(Router& router) {
  using Type = QueryParameter::Type;
  using Parts = Router::Parts;
  router.add("POST", "/api/figures",
             {.summary = "Draws a figure (docs/figures.md) of jobs or a sweep, named by their ids",
              .query = {{"format", Type::text, "pdf (default), svg or png"}},
              .body_types = {"application/json"},
              .body_schema = figure_schema(),
              .answers = {{200, "the figure"},
                          {400, "it is not valid, or names what its jobs do not have"},
                          {409, "a picture or a reference cannot be used"},
                          {503, "two are being made, or there is too little memory"},
                          {504, "it took longer than two minutes"}}},
             [this](const Request& request, const Parts&) { return figure(request); });
  router.add("GET", "/api/schema/figure", {.summary = "The JSON Schema of a figure"},
             [](const Request& request, const Parts&) {
               return with_tag(request, json_response(200, figure_schema()));
             });
  router.add("POST", "/api/jobs/{id}/trace",
             {.summary = "The brightest paths of a pixel (docs/light-paths.md)",
              .query = {{"x", Type::integer, "column, from the left", 0, 65535},
                        {"y", Type::integer, "row, from above", 0, 65535},
                        {"samples", Type::integer, "iterations to trace (64)", 1, 1 << 20},
                        {"brightest", Type::integer, "paths to return (10)", 1, 1000}},
              .answers = {{200, "{pixel, samples, seed, mean, bounds, count, paths}"},
                          {400, "there is no such pixel, or its method keeps no whole paths"},
                          {404, "no such job"},
                          {409, "its scene cannot be used"},
                          {503, "two are being made, or there is too little memory"},
                          {504, "it took longer than two minutes"}}},
             with_id(*this, &ToolRoutes::trace));
}

}  // namespace lacuna
