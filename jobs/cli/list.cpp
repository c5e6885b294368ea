#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "jobs/cli/commands.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

namespace {

void print_jobs() {
  fmt::print("{:<24} {:<12} {:>6} {:>10}  {}\n", "ID", "STATE", "%", "ERROR", "SCENE  LABEL");
  for (const JobFolder& folder : list_jobs(DataRoot::from_environment().jobs())) {
    const JobSpec spec = folder.read_job();
    const auto progress = folder.read_progress();
    fmt::print("{:<24} {:<12} {:>6} {:>10}  {}  {}\n", folder.id(),
               enum_name(folder.read_state().state),
               progress ? fmt::format("{:.0f}", 100 * progress->share) : "",
               progress && progress->error ? fmt::format("{:.3g}", *progress->error) : "",
               spec.scene, spec.label);
  }
}

void print_scenes() {
  for (const std::string& name : ScenesRoots::from_environment().list()) fmt::print("{}\n", name);
}

}  // namespace

void add_list(CLI::App& app, int& code) {
  const auto scenes = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("list", "List the jobs of the data folder, oldest first");
  command->add_flag("--scenes", *scenes, "list the scenes that jobs can name instead");
  command->callback([scenes, &code] {
    if (*scenes) {
      print_scenes();
    } else {
      print_jobs();
    }
    code = exit_done;
  });
}

}  // namespace lacuna
