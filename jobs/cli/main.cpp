#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "jobs/cli/commands.h"
#include "jobs/run/obstacle.h"
#include "jobs/spec/problems.h"
#include "jobs/spec/version.h"
#include "renderer/geometry/scene_data.h"

namespace {

constexpr const char* about =
    "Lacuna renders light transport in occluded scenes and measures error against time.";
constexpr const char* footer =
    "Exit codes: 0 done, 1 other error, 2 bad job or command line, 3 scene or other asset,\n"
    "71 out of memory, 75 interrupted, disk full, or a file that cannot be read now (the same "
    "command\ncontinues from the checkpoint).\n"
    "Environment: LACUNA_SCENES, folders of scenes (separated by ':');\n"
    "LACUNA_DATA, folder of jobs, references and cache (default: lacuna-data);\n"
    "LACUNA_CACHE, another folder for the cache of artefacts; LACUNA_CACHE_LIMIT, its size limit,\n"
    "for example 4G (default: 10G); LACUNA_GRACE, seconds that a stop may take to write a "
    "checkpoint\n"
    "(default and at least: 2).";

int run(int argc, char** argv) {
  CLI::App app(about, "lacuna");
  app.footer(footer);
  app.set_version_flag("--version", "lacuna " + lacuna::version());
  app.require_subcommand(1);
  int code = lacuna::exit_done;
  lacuna::add_render(app, code);
  lacuna::add_extend(app, code);
  lacuna::add_merge(app, code);
  lacuna::add_check(app, code);
  lacuna::add_import(app, code);
  lacuna::add_schema(app, code);
  lacuna::add_list(app, code);
  lacuna::add_compare(app, code);
  lacuna::add_advise(app, code);
  lacuna::add_cache(app, code);
  lacuna::add_analyze(app, code);
  lacuna::add_trace(app, code);
  lacuna::add_sweep(app, code);
  lacuna::add_report(app, code);
  lacuna::add_archive(app, code);
  lacuna::add_figure(app, code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? lacuna::exit_done : lacuna::exit_bad_job;
  }
  return code;
}

}  // namespace

lacuna::ExitCode lacuna::exit_code_of(const std::exception& e) {
  switch (obstacle_of(e)) {
    case Obstacle::memory:
      return exit_memory;
    case Obstacle::storage:
    case Obstacle::input:
      return exit_interrupted;
    case Obstacle::none:
      break;
  }
  if (dynamic_cast<const BadJob*>(&e) != nullptr) return exit_bad_job;
  if (dynamic_cast<const SceneError*>(&e) != nullptr) return exit_asset;
  return exit_error;
}

int main(int argc, char** argv) {
  try {
    lacuna::watch_memory();
    return run(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "lacuna: {}\n", lacuna::reason_of(e));
    return lacuna::exit_code_of(e);
  }
}
