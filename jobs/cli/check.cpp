#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "analysis/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/terminal.h"
#include "jobs/run/run_job.h"
#include "jobs/spec/job_json.h"

namespace lacuna {

void add_check(CLI::App& app, int& code) {
  const auto job = std::make_shared<std::filesystem::path>();
  CLI::App* command = app.add_subcommand(
      "check",
      "Validate a job file and load all it names, without rendering; prints it with its defaults");
  command->add_option("JOB", *job, "a job file (JSON)")->required()->check(CLI::ExistingFile);
  command->callback([job, &code] {
    const JobSpec spec = parse_job(read_file(*job, max_job_bytes));
    Terminal terminal({}, true);
    const RunContext context{DataRoot::from_environment(), ScenesRoots::from_environment(), -1,
                             interrupt_requested(), terminal};
    for (const std::string& w : check_job(spec, context)) terminal.warning(w);
    fmt::print("{}", write_job(spec));
    code = exit_done;
  });
}

}  // namespace lacuna
