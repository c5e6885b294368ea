#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/json/json_text.h"
#include "base/parallel/stop.h"
#include "base/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/overlay.h"
#include "jobs/cli/results_folder.h"
#include "jobs/cli/terminal.h"
#include "jobs/run/pixel_paths.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/problems.h"

namespace lacuna {

namespace {

struct TraceOptions {
  std::filesystem::path job, glb;
  std::array<int, 2> pixel{};
  std::uint64_t samples = 64;
  std::size_t brightest = 10;
  int threads = -1;
  bool json = false;
};

std::string point_text(const OrderedJson& p) {
  return fmt::format("{:>10.4g} {:>10.4g} {:>10.4g}", p[0].get<double>(), p[1].get<double>(),
                     p[2].get<double>());
}

void print_paths(const OrderedJson& found) {
  fmt::print("pixel {}, {}: mean {} over {} samples, seed {}; {} paths contribute\n",
             json_text(found["pixel"][0]), json_text(found["pixel"][1]), point_text(found["mean"]),
             json_text(found["samples"]), json_text(found["seed"]), json_text(found["count"]));
  int number = 0;
  for (const OrderedJson& p : found["paths"]) {
    fmt::print(
        "\n{:>3}. {}  iteration {}, s {} t {}, MIS weight {:.3g}, value {}, {:.1f} % of all\n",
        ++number, p["letters"].get<std::string>(), json_text(p["iteration"]), json_text(p["s"]),
        json_text(p["t"]), p["weight"].get<double>(), point_text(p["value"]),
        100 * p["share"].get<double>());
    const auto letters = p["letters"].get<std::string>();
    std::size_t i = 0;
    for (const OrderedJson& v : p["vertices"]) {
      const bool infinite = v.contains("direction");
      fmt::print("     {}  {} {}  from {:<5}  {}\n", letters[i++], infinite ? "to" : "at",
                 point_text(v[infinite ? "direction" : "position"]), v["from"].get<std::string>(),
                 v["density"] == 0.0
                     ? ""
                     : fmt::format("density {:.4g} per {}", v["density"].get<double>(),
                                   infinite ? "steradian" : "area"));
    }
    if (p["vertices"].empty()) fmt::print("     the mean of several camera rays\n");
  }
}

void trace(const TraceOptions& o) {
  const JobSpec spec = std::filesystem::is_directory(o.job)
                           ? JobFolder(folder_path(o.job)).read_job()
                           : parse_job(read_file(o.job, max_job_bytes));
  if (const std::string_view reason = without_traces(spec.integrator); !reason.empty()) {
    const auto name = std::visit([](const auto& s) { return s.name; }, spec.integrator);
    throw BadJob({{"/integrator", fmt::format("found \"{}\", which {}", name, reason)}});
  }
  Terminal terminal({}, true);
  const RunContext context{DataRoot::from_environment(), ScenesRoots::from_environment(), o.threads,
                           interrupt_requested(), terminal};
  const Prepared prepared = prepare(spec, context);
  analyse(prepared, *prepared.integrator);
  prepared.space->close();
  const PixelPaths found = trace_pixel(spec, prepared, o.pixel, o.samples, interrupt_requested());
  const SceneData& scene = prepared.scene->data();
  if (!o.glb.empty()) {
    const std::size_t shown = std::min(o.brightest, found.paths.size());
    write_overlay(o.glb, scene, path_overlay(std::span(found.paths).first(shown), scene.bounds()));
  }
  const OrderedJson json = pixel_paths_json(found, scene, o.brightest);
  if (o.json) {
    fmt::print("{}", document_text(json));
  } else {
    print_paths(json);
  }
}

}  // namespace

void add_trace(CLI::App& app, int& code) {
  const auto o = std::make_shared<TraceOptions>();
  CLI::App* command = app.add_subcommand(
      "trace", "Show the brightest paths of a pixel: its vertices, densities and weights");
  command->add_option("JOB", o->job, "a job file (JSON) or a job's folder")
      ->required()
      ->check(existing_path);
  command->add_option("--pixel", o->pixel, "column and row from the upper left, as X,Y")
      ->delimiter(',')
      ->required();
  command
      ->add_option("--samples", o->samples,
                   "number of the job's iterations to trace, from the first on")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 32))
      ->capture_default_str();
  command->add_option("--brightest", o->brightest, "number of paths to show")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--glb", o->glb, "also write these paths, over the scene, as a GLB");
  command
      ->add_option("-t,--threads", o->threads,
                   "number of threads; 0: one per core (default: job's)")
      ->check(CLI::Range(0, 1024));
  command->add_flag("--json", o->json, "print JSON instead of a table");
  command->callback([o, &code] {
    try {
      trace(*o);
      code = exit_done;
    } catch (const Stopped&) {
      code = exit_interrupted;
    }
  });
}

}  // namespace lacuna
