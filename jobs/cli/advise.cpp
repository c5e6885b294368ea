#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <system_error>

#include "base/parallel/stop.h"
#include "base/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/terminal.h"
#include "jobs/run/advise.h"
#include "jobs/spec/described_json.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/limits.h"

namespace lacuna {

namespace {

struct AdviseOptions {
  std::string what, camera;
  std::filesystem::path out;
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
  return with_auto_integrator(spec);
}

/// Prints the last turn of each candidate.
void print_table(const Choice& choice) {
  const std::string error = fmt::format("{} then", enum_name(choice.metric));
  fmt::print("{:<32} {:>10} {:>9} {:>12}  {}\n", "method", "iterations", "CPU s", error, "");
  for (std::size_t k = 0; k < choice.candidates.size(); ++k) {
    const Candidate& c = choice.candidates[k];
    const Turn turn = c.turns.empty() ? Turn{} : c.turns.back();
    const bool chosen = choice.chosen == int(k);
    fmt::print("{:<32} {:>10} {:>9.3f} {:>12}  {}\n", c.name, turn.iterations, turn.cpu_seconds,
               turn.expected ? fmt::format("{:.3g}", *turn.expected) : "-",
               chosen ? "<- chosen" : c.left);
  }
  fmt::print("\n\"{} then\": expected at the end of the budget\n", enum_name(choice.metric));
}

/// A temporary folder, removed with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "lacuna-advise-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw std::system_error(errno, std::generic_category(), name);
    }
    dir_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(dir_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& dir() const { return dir_; }

 private:
  std::filesystem::path dir_;
};

}  // namespace

void add_advise(CLI::App& app, int& code) {
  const auto o = std::make_shared<AdviseOptions>();
  CLI::App* command = app.add_subcommand(
      "advise", "Choose the best method for a scene and a budget by rendering with several");
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
  command->add_option("-o,--out", o->out,
                      "keep the job in this folder, so that `lacuna render` can continue it");
  command->add_flag("--json", o->json, "print choice.json instead of a table");
  command->callback([o, &code] {
    Terminal terminal({}, true);
    const RunContext context{DataRoot::from_environment(), ScenesRoots::from_environment(),
                             o->threads, interrupt_requested(), terminal};
    try {
      const TemporaryFolder temporary;
      const auto dir = o->out.empty() ? temporary.dir() / "job" : o->out;
      const Choice choice = advise(JobFolder::create(dir, job_of(*o)), context);
      if (o->json) {
        fmt::print("{}", write_document(choice));
      } else {
        print_table(choice);
      }
      code = exit_done;
    } catch (const Stopped&) {
      code = exit_interrupted;
    }
  });
}

}  // namespace lacuna
