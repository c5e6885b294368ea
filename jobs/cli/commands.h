#pragma once

#include <exception>

namespace CLI {
class App;
}

namespace lacuna {

/// Exit codes of `lacuna`, printed by --help.
enum ExitCode : int {
  exit_done = 0,
  exit_error = 1,    ///< something else went wrong
  exit_bad_job = 2,  ///< the job file or the command line
  exit_asset = 3,    ///< a scene, texture, reference or environment
  exit_memory = 71,  ///< out of memory; with more, the same command goes on
  exit_interrupted =
      75  ///< stopped with a checkpoint, or the disk is full; the same command goes on
};

/// The one place that knows which exception ends the program with which code.
ExitCode exit_code_of(const std::exception& e);

/// Each adds one subcommand; what it returns from its callback is put into `code`.
void add_render(CLI::App& app, int& code);
void add_check(CLI::App& app, int& code);
void add_schema(CLI::App& app, int& code);
void add_list(CLI::App& app, int& code);
void add_compare(CLI::App& app, int& code);
void add_cache(CLI::App& app, int& code);
void add_analyze(CLI::App& app, int& code);
void add_sweep(CLI::App& app, int& code);
void add_report(CLI::App& app, int& code);

}  // namespace lacuna
