#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "jobs/cli/commands.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/page_tables.h"
#include "jobs/store/state.h"

namespace lacuna {

void add_schema(CLI::App& app, int& code) {
  const auto markdown = std::make_shared<bool>(false);
  const auto sweep = std::make_shared<bool>(false);
  const auto figure = std::make_shared<bool>(false);
  const auto states = std::make_shared<bool>(false);
  const auto page = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("schema", "Print the JSON Schema of the job file, or other documentation");
  command->add_flag("--sweep", *sweep, "the JSON Schema of the sweep file");
  command->add_flag("--figure", *figure, "the JSON Schema of a figure's file")->excludes("--sweep");
  command->add_flag("--markdown", *markdown, "documentation of all settings (Markdown)");
  command->add_flag("--states", *states, "the states of a job and the allowed changes (Markdown)")
      ->excludes("--markdown", "--sweep", "--figure");
  command->add_flag("--page", *page, "the module /job_tables.js of the page")
      ->excludes("--markdown", "--sweep", "--figure", "--states");
  command->callback([sweep, figure, markdown, states, page, &code] {
    fmt::print("{}", *page       ? page_tables_module()
                     : *states   ? state_documentation()
                     : *markdown ? (*sweep    ? sweep_documentation()
                                    : *figure ? figure_documentation()
                                              : job_documentation())
                                 : (*sweep    ? sweep_schema()
                                    : *figure ? figure_schema()
                                              : job_schema()));
    code = exit_done;
  });
}

}  // namespace lacuna
