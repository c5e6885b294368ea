#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "base/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/terminal.h"
#include "jobs/run/check.h"
#include "jobs/spec/job_json.h"

namespace lacuna {

namespace {

void check_job_file(const std::filesystem::path& job) {
  const JobSpec spec = parse_job(read_file(job, max_job_bytes));
  Terminal terminal({}, true);
  const RunContext context{DataRoot::from_environment(), ScenesRoots::from_environment(), -1,
                           interrupt_requested(), terminal};
  for (const std::string& w : check_job(spec, context)) terminal.warning(w);
  fmt::print("{}", write_job(spec));
}

void check_scene_file(const std::filesystem::path& file) {
  const ThreadPool pool(0);
  Terminal terminal({}, true);
  const SceneCounts c = check_scene(file, pool);
  for (const std::string& w : c.warnings) terminal.warning(w);
  fmt::print("{}: {} triangles, {} materials, {} textures, {} cameras, {} lights\n",
             file.filename().string(), c.triangles, c.materials, c.textures, c.cameras, c.lights);
}

}  // namespace

void add_check(CLI::App& app, int& code) {
  const auto job = std::make_shared<std::filesystem::path>();
  const auto scene = std::make_shared<std::filesystem::path>();
  CLI::App* command = app.add_subcommand("check",
                                         "Validate a job file, load everything it names without "
                                         "rendering, and print it with defaults");
  command->add_option("JOB", *job, "a job file (JSON)")->check(CLI::ExistingFile);
  command
      ->add_option("--scene", *scene, "check a scene (.glb, .gltf) instead and print its contents")
      ->check(CLI::ExistingFile);
  command->require_option(1);
  command->callback([job, scene, &code] {
    if (scene->empty()) {
      check_job_file(*job);
    } else {
      check_scene_file(*scene);
    }
    code = exit_done;
  });
}

}  // namespace lacuna
