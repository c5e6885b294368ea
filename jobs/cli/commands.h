#pragma once

#include <exception>

#include "jobs/store/exit_code.h"

namespace CLI {
class App;
}

namespace lacuna {

/// The exit code for an exception that ends the program.
ExitCode exit_code_of(const std::exception& e);

/// Each function adds one subcommand, whose callback sets `code` to the exit code.
void add_render(CLI::App& app, int& code);
void add_extend(CLI::App& app, int& code);
void add_merge(CLI::App& app, int& code);
void add_check(CLI::App& app, int& code);
void add_import(CLI::App& app, int& code);
void add_schema(CLI::App& app, int& code);
void add_list(CLI::App& app, int& code);
void add_compare(CLI::App& app, int& code);
void add_advise(CLI::App& app, int& code);
void add_cache(CLI::App& app, int& code);
void add_analyze(CLI::App& app, int& code);
void add_trace(CLI::App& app, int& code);
void add_sweep(CLI::App& app, int& code);
void add_report(CLI::App& app, int& code);
void add_archive(CLI::App& app, int& code);
void add_figure(CLI::App& app, int& code);

}  // namespace lacuna
