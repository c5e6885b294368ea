#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "base/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/scene_choice_options.h"
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

void check_scene_file(const std::filesystem::path& file, const SceneChoice& choice) {
  const ThreadPool pool(0);
  Terminal terminal({}, true);
  const SceneCounts c = check_scene(file, choice, pool);
  for (const std::string& w : c.warnings) terminal.warning(w);
  fmt::print("{}: {} triangles, {} materials, {} textures, {} cameras, {} lights\n",
             file.filename().string(), c.triangles, c.materials, c.textures, c.cameras, c.lights);
  const auto point = [](const V3d& p) { return fmt::format("[{:g}, {:g}, {:g}]", p.x, p.y, p.z); };
  fmt::print("  box: {} to {}\n", point(c.box.low), point(c.box.high));
  std::size_t widest = 0;
  for (const FeatureUse& f : c.features) widest = std::max(widest, f.name.size());
  for (const FeatureUse& f : c.features) {
    fmt::print("  {:<{}}  {:<12}  {}\n", f.name, widest, f.treatment, f.how);
  }
  for (const std::string& camera : c.views) fmt::print("  {}\n", camera);
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
      ->add_option("--scene", *scene,
                   "check a scene (.glb, .gltf) instead and print its contents: what of "
                   "glTF it uses and how that is treated, and its cameras")
      ->check(CLI::ExistingFile)
      ->excludes("JOB");
  const auto choice = std::make_shared<SceneChoice>();
  add_scene_choice(*command, *choice);
  const auto features = std::make_shared<bool>(false);
  command->add_flag("--features", *features,
                    "print what is read of glTF, and how, as a table in Markdown");
  command->require_option(1, 0);
  command->callback([job, scene, choice, features, &code] {
    if (*features) {
      fmt::print("{}", feature_table());
    } else if (scene->empty()) {
      if (job->empty()) throw CLI::RequiredError("JOB or --scene");
      check_job_file(*job);
    } else {
      check_scene_file(*scene, *choice);
    }
    code = exit_done;
  });
}

}  // namespace lacuna
