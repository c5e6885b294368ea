#pragma once

#include <exception>

#include "jobs/store/exit_code.h"

namespace CLI {
class App;
}

namespace lacuna {

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
