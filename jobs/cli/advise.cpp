#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/json/json_text.h"
#include "base/parallel/stop.h"
#include "base/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/terminal.h"
#include "jobs/run/advise.h"
#include "jobs/run/race_json.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/limits.h"

namespace lacuna {

namespace {

struct AdviseOptions {
  std::string what, camera;
  double seconds = Budget::default_seconds;
  std::vector<int> resolution;
  int max_depth = PathLengths{}.max_depth;
  int threads = -1;
  bool json = false;
};

JobSpec job_of(const AdviseOptions& o) {
  JobSpec spec;
  if (std::filesystem::path(o.what).extension() == ".json") {
    spec = parse_job(read_file(o.what, max_job_bytes));
  } else {
    spec.scene = o.what;
    AutoSettings choosing;
    choosing.max_depth = o.max_depth;
    choosing.roulette_depth = std::min(choosing.roulette_depth, o.max_depth);
    spec.integrator = choosing;
  }
  if (!o.camera.empty()) spec.camera.name = o.camera;
  if (o.resolution.size() == 2) spec.resolution = {o.resolution[0], o.resolution[1]};
  spec.budget = {};
  spec.budget.cpu_seconds = o.seconds;
  return spec;
}

/// What remains of the budget for a candidate's iterations, were it alone.
double rest(const RaceRecord& race, double preparation) {
  return std::max(0.0, race.budget - preparation);
}

void print_table(const RaceRecord& race) {
  fmt::print("{:<28} {:>10} {:>9} {:>16} {:>8}  {}\n", "method", "rmse", "mse/best", "interval",
             "prepare", "");
  for (const RaceRecord::Candidate& c : race.candidates) {
    const Standing& s = c.standing;
    const double time = rest(race, c.preparation);
    const bool known = s.error > 0 && time > 0;
    const auto factor = [&](double z) {
      return std::exp(s.over_best.value + z * s.over_best.deviation);
    };
    fmt::print("{:<28} {:>10} {:>9} {:>16} {:>7.1f}s  {}\n", c.name,
               known ? fmt::format("{:.3g}", std::sqrt(s.error / time)) : "-",
               known ? fmt::format("{:.2f}", factor(0)) : "-",
               known ? fmt::format("{:.2f} - {:.2f}", factor(-2), factor(2)) : "-", c.preparation,
               c.share > 0 ? "<- chosen" : c.reason);
    if (!c.biased || !known) continue;
    fmt::print("{:28} {}\n", "",
               s.bias > 2 * s.bias_deviation
                   ? fmt::format("bias: rmse {:.3g} stays", std::sqrt(s.bias))
                   : fmt::format("bias: not seen, rmse below {:.3g}",
                                 std::sqrt(s.bias + 2 * s.bias_deviation)));
  }
}

void print_advice(const RaceRecord& race) {
  std::string names;
  bool known = true;
  for (const RaceRecord::Candidate& c : race.candidates) {
    if (c.share == 0) continue;
    names += (names.empty() ? "" : " and ") + c.name;
    known = known && c.standing.tail_known.value_or(true) && !c.standing.unexplained;
  }
  fmt::print("\n{:g} s: {}", race.budget, names);
  const double left = race.budget - race.spent;
  if (race.error > 0 && left > 0) {
    fmt::print(", rmse {:.3g} expected", std::sqrt(race.error / left));
  }
  fmt::print(". The race took {:.2f} s", race.spent);
  if (race.reduction > 1) fmt::print(", of pixels {} times as wide", race.reduction);
  fmt::print(".\n");
  if (!known) {
    fmt::print("Not sure: rare bright paths carry much of the error, and more may be to come.\n");
  }
}

}  // namespace

void add_advise(CLI::App& app, int& code) {
  const auto o = std::make_shared<AdviseOptions>();
  CLI::App* command = app.add_subcommand(
      "advise", "Let methods race on a scene, and tell which is best for a budget");
  command
      ->add_option("WHAT", o->what,
                   "a scene (.glb, .gltf) below a scenes root, or a job file (.json)")
      ->required();
  command->add_option("--seconds", o->seconds, "the budget: CPU seconds of each thread")
      ->check(CLI::Range(1e-3, 1e7))
      ->capture_default_str();
  command->add_option("--camera", o->camera, "one of the scene's cameras; default: its first");
  command->add_option("--resolution", o->resolution, "width and height, pixels (default: 512 512)")
      ->expected(2)
      ->check(CLI::Range(1, 16384));
  command->add_option("--max_depth", o->max_depth, "longest path of a scene's picture, edges")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command
      ->add_option("-t,--threads", o->threads,
                   "number of threads; 0: one per core (default: job's)")
      ->check(CLI::Range(0, 1024));
  command->add_flag("--json", o->json, "print the race as in report.json");
  command->callback([o, &code] {
    Terminal terminal({}, true);
    const RunContext context{DataRoot::from_environment(), ScenesRoots::from_environment(),
                             o->threads, interrupt_requested(), terminal};
    try {
      const RaceRecord race = advise(job_of(*o), context);
      if (o->json) {
        fmt::print("{}", document_text(race_json(race)));
      } else {
        print_table(race);
        print_advice(race);
      }
      code = exit_done;
    } catch (const Stopped&) {
      code = exit_interrupted;
    }
  });
}

}  // namespace lacuna
