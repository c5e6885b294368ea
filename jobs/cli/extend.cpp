#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "jobs/cli/commands.h"
#include "jobs/cli/render_job.h"
#include "jobs/run/input_check.h"
#include "jobs/run/run_job.h"
#include "jobs/spec/budget_extension.h"
#include "jobs/spec/described_json.h"
#include "jobs/spec/job_json.h"
#include "jobs/store/new_folder.h"

namespace lacuna {

namespace {

struct ExtendOptions {
  std::filesystem::path folder;
  Budget budget;                ///< without its error target
  std::optional<double> error;  ///< in the job's metric
  RenderOptions render;
};

Budget larger_budget(const Budget& old, const ExtendOptions& o) {
  Budget larger = o.budget;
  if (!o.error) return larger;
  if (!old.error) {
    throw BadJob(
        {{"", fmt::format("--error {}: the job has no error target, so no metric; allowed: "
                          "--seconds, --cpu-seconds, --iterations",
                          *o.error)}});
  }
  larger.error = ErrorTarget{old.error->metric, *o.error};
  return larger;
}

/// Writes the larger budget and reopens the job.
void extend(const JobFolder& folder, const ExtendOptions& o) {
  const auto lock = folder.try_lock();
  if (!lock) {
    throw FolderBusy(
        fmt::format("{}: another process is rendering this job", folder.dir().string()));
  }
  JobSpec spec = folder.read_job();
  const Budget larger = larger_budget(spec.budget, o);
  throw_if_any(extension_problems(spec.budget, larger));
  spec.budget = larger;
  parse_job(write_job(spec));  // checks ranges
  // Before anything is written: a refusal changes nothing.
  InputCheck check(DataRoot::from_environment(), ScenesRoots::from_environment());
  refuse_changed_inputs(folder, check.changes(folder).value_or(std::vector<std::string>{}));
  // State first: after a crash in between, the job ends at once with its old budget instead of
  // being marked done although it is not.
  if (is_terminal(folder.read_state().state)) folder.reopen();
  folder.write_job(spec);
}

}  // namespace

void add_extend(CLI::App& app, int& code) {
  const auto o = std::make_shared<ExtendOptions>();
  CLI::App* command = app.add_subcommand("extend",
                                         "Give a job's folder a larger budget and continue "
                                         "rendering from its checkpoint, also after it is done");
  command->footer(
      "The given limits replace the whole budget: other limits of the job are dropped. None may "
      "be\nsmaller than before. After a stop, `lacuna render FOLDER` continues.");
  command->add_option("FOLDER", o->folder, "a job's folder")
      ->required()
      ->check(CLI::ExistingDirectory);
  command->add_option("--seconds", o->budget.seconds, "total render time, wall clock");
  command->add_option("--cpu-seconds", o->budget.cpu_seconds,
                      "total render time, CPU seconds / threads");
  command->add_option("--iterations", o->budget.iterations, "total iterations");
  command->add_option("--error", o->error, "error target, in the job's metric");
  command
      ->add_option("-t,--threads", o->render.threads,
                   "number of threads instead of the job's; 0: one per core")
      ->check(CLI::Range(0, 1024));
  command->add_flag("-q,--quiet", o->render.quiet, "show warnings and errors only");
  command->callback([o, &code] {
    const JobFolder folder(folder_path(o->folder));
    extend(folder, *o);
    code = render_folder(folder, o->render);
  });
}

}  // namespace lacuna
