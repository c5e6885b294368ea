#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>

#include "analysis/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/render_job.h"
#include "jobs/cli/results_folder.h"
#include "jobs/cli/terminal.h"
#include "jobs/render/run_job.h"
#include "jobs/run/obstacle.h"
#include "jobs/spec/byte_size.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/problems.h"

namespace lacuna {

namespace {

namespace fs = std::filesystem;

/// "raise the limit of 4.0 GiB (ulimit -d), ", for each that this process has.
std::string memory_limit_advice() {
  std::string advice;
  for (const auto& [resource, option] : {std::pair{RLIMIT_DATA, "-d"}, {RLIMIT_AS, "-v"}}) {
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) continue;
    advice +=
        fmt::format("raise the limit of {} (ulimit {}), ", byte_size_text(limit.rlim_cur), option);
  }
  return advice;
}

/// The folder of a job file's results: there already with this very job, or made now.
JobFolder folder_for(const fs::path& job_file, const fs::path& named) {
  const JobSpec spec = parse_job(read_file(job_file, max_job_bytes));
  const fs::path out = results_folder(job_file, named, ".job");
  if (!fs::exists(out / "job.json")) {
    if (fs::exists(out) && !fs::is_empty(out)) {
      throw BadJob({{"", fmt::format("--out {}: exists and is not a job's folder", out.string())}});
    }
    if (fs::exists(out)) fs::remove(out);
    fs::create_directories(out.parent_path());
    return JobFolder::create(out, spec);
  }
  JobFolder folder(out);
  if (folder.read_job() != spec) {
    throw BadJob(
        {{"", fmt::format("{} holds another job; name another folder with --out", out.string())}});
  }
  return folder;
}

/// What a person can do about it.
std::string advice_for(Obstacle obstacle) {
  switch (obstacle) {
    case Obstacle::none:
      return "";
    case Obstacle::memory:
      return memory_limit_advice() +
             "free memory, or ask for a smaller resolution or fewer layers; the same command goes "
             "on from the last checkpoint";
    case Obstacle::storage:
      return "nothing stored is lost: with room to write the same command goes on from the last "
             "checkpoint";
  }
  return "";
}

}  // namespace

int render_folder(const JobFolder& folder, const RenderOptions& options) {
  // A full disk or a size limit must become an error, not the end of the process.
  signal(SIGXFSZ, SIG_IGN);
  Terminal terminal(folder.file("log.txt"), options.quiet);
  const RunContext context{DataRoot::from_environment(), ScenesRoots::from_environment(),
                           options.threads, interrupt_requested(), terminal};
  try {
    if (folder.read_state().state == State::done) {
      terminal.milestone(fmt::format("{}: done already", folder.dir().string()));
      return exit_done;
    }
    if (run_job(folder, context) == Outcome::interrupted) {
      terminal.milestone("interrupted; the same command continues from here");
      return exit_interrupted;
    }
  } catch (const std::exception& e) {
    const std::string advice = advice_for(obstacle_of(e));
    terminal.error(reason_of(e) + (advice.empty() ? "" : "; " + advice));
    return exit_code_of(e);
  }
  terminal.milestone(fmt::format("done: {}", folder.file("image.exr").string()));
  return exit_done;
}

void add_render(CLI::App& app, int& code) {
  struct Options : RenderOptions {
    fs::path job, out;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("render", "Render a job file, or continue a job's folder");
  command->add_option("JOB", o->job, "a job file (JSON), or a job's folder")
      ->required()
      ->check(CLI::ExistingPath);
  command->add_option("-o,--out", o->out, "folder for the results (default: NAME.job)");
  command
      ->add_option("-t,--threads", o->threads,
                   "number of threads instead of the job's; 0: one per core")
      ->check(CLI::Range(0, 1024));
  command->add_flag("-q,--quiet", o->quiet, "show warnings and errors only");
  command->callback([o, &code] {
    const JobFolder folder =
        fs::is_directory(o->job) ? JobFolder(folder_path(o->job)) : folder_for(o->job, o->out);
    code = render_folder(folder, *o);
  });
}

}  // namespace lacuna
