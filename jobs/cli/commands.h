#pragma once

namespace CLI {
class App;
}

namespace lacuna {

/// Exit codes of `lacuna`, printed by --help.
enum ExitCode : int {
  exit_done = 0,
  exit_error = 1,        ///< something else went wrong
  exit_bad_job = 2,      ///< the job file or the command line
  exit_asset = 3,        ///< a scene, texture, reference or environment
  exit_interrupted = 75  ///< stopped with a checkpoint; the same command goes on
};

/// Each adds one subcommand; what it returns from its callback is put into `code`.
void add_render(CLI::App& app, int& code);
void add_check(CLI::App& app, int& code);
void add_schema(CLI::App& app, int& code);
void add_list(CLI::App& app, int& code);
void add_compare(CLI::App& app, int& code);

}  // namespace lacuna
