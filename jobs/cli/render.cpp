#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "base/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/render_job.h"
#include "jobs/cli/results_folder.h"
#include "jobs/cli/terminal.h"
#include "jobs/run/obstacle.h"
#include "jobs/run/run_job.h"
#include "jobs/spec/byte_size.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/problems.h"

namespace lacuna {

namespace {

namespace fs = std::filesystem;

/// "raise the limit of 4.0 GiB (ulimit -d), ", for each limit of this process.
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

/// Makes `spec` the job of the shard `text`, "K/N". Throws BadJob.
void choose_shard(JobSpec& spec, const std::string& text) {
  const auto refuse = [&](const std::string& why) {
    throw BadJob({{"", fmt::format("--shard {}: {}", text, why)}});
  };
  int end = 0;
  int k = 0, n = 0;
  if (std::sscanf(text.c_str(), "%d/%d%n", &k, &n, &end) != 2 ||
      static_cast<std::size_t>(end) != text.size() || k < 1 || k > n) {
    refuse("allowed: K/N, with K from 1 to N");
  }
  if (spec.shards > 1 && spec.shards != n) {
    refuse(fmt::format("the job has {} shards; allowed: 1/{} to {}/{}", spec.shards, spec.shards,
                       spec.shards, spec.shards));
  }
  if (spec.shard > 0 && spec.shard != k) {
    refuse(fmt::format("the job is already shard {}", spec.shard));
  }
  spec.shards = n;
  spec.shard = k;
  parse_job(write_job(spec));  // checks ranges
  budget_of(spec);
}

/// ".job", or of a shard ".03-of-12.job", so that they sort.
std::string folder_ending(const JobSpec& spec) {
  if (spec.shard == 0) return ".job";
  const std::string all = fmt::format("{}", spec.shards);
  return fmt::format(".{:0{}}-of-{}.job", spec.shard, all.size(), all);
}

/// The folder of a job file's results: an existing one with the same job, or a new one. `shard`: of
/// the command line; empty: none.
JobFolder folder_for(const fs::path& job_file, const fs::path& named, const std::string& shard) {
  JobSpec spec = parse_job(read_file(job_file, max_job_bytes));
  if (!shard.empty()) choose_shard(spec, shard);
  const fs::path out = results_folder(job_file, named, folder_ending(spec));
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
    throw BadJob({{"", fmt::format("{} contains another job; choose another folder with --out",
                                   out.string())}});
  }
  return folder;
}

/// Advice about the obstacle.
std::string advice_for(Obstacle obstacle) {
  switch (obstacle) {
    case Obstacle::none:
      return "";
    case Obstacle::memory:
      return memory_limit_advice() +
             "free memory, or use a smaller resolution or fewer layers; the same command continues "
             "from the last checkpoint";
    case Obstacle::storage:
      return "nothing stored is lost: once there is space, the same command continues from the "
             "last checkpoint";
    case Obstacle::input:
      return "this may be transient: once the file can be read, the same command continues";
  }
  return "";
}

}  // namespace

void start_again(const JobFolder& folder) {
  const auto lock = folder.try_lock();
  if (!lock) {
    throw FolderBusy(
        fmt::format("{}: another process is rendering this job", folder.dir().string()));
  }
  folder.reopen();  // first: a job that is done has a checkpoint
  for (const char* name : {"checkpoint.bin", "inputs.json", "progress.json", "choice.json",
                           "candidates", "measured.json"}) {
    fs::remove_all(folder.file(name));
  }
}

int render_folder(const JobFolder& folder, const RenderOptions& options) {
  // A full disk or a size limit must become an error, not the end of the process.
  signal(SIGXFSZ, SIG_IGN);
  Terminal terminal(folder.file("log.txt"), options.quiet);
  const double grace = stop_grace();
  const RunContext context{DataRoot::from_environment(),
                           ScenesRoots::from_environment(),
                           options.threads,
                           interrupt_requested(),
                           terminal,
                           options.shards,
                           [grace] { return seconds_to_write(grace); },
                           options.trace};
  try {
    const bool was_done = folder.read_state().state == State::done;
    const Outcome outcome = run_job(folder, context);
    if (was_done) {
      terminal.milestone(fmt::format("{}: already done", folder.dir().string()));
      return exit_done;
    }
    if (outcome == Outcome::interrupted) {
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
    std::string shard;
    bool again = false;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("render", "Render a job file, or continue a job's folder");
  command->add_option("JOB", o->job, "a job file (JSON), or a job's folder")
      ->required()
      ->check(existing_path);
  command->add_option("-o,--out", o->out, "folder for the results (default: NAME.job)");
  command->add_option(
      "--shard", o->shard,
      "K/N: render only the K-th of N parts of the iterations, into NAME.K-of-N.job; "
      "`lacuna merge` merges all N");
  command
      ->add_option("-t,--threads", o->threads,
                   "number of threads instead of the job's; 0: one per core")
      ->check(CLI::Range(0, 1024));
  command->add_option("--trace", o->trace,
                      "also write the work of each thread to this file, in Chrome's trace format");
  command->add_flag("--again", o->again,
                    "discard the results and render again from the present files");
  command->add_flag("-q,--quiet", o->quiet, "show warnings and errors only");
  command->callback([o, &code] {
    const bool is_folder = fs::is_directory(o->job);
    if (is_folder && !o->shard.empty()) {
      throw BadJob(
          {{"",
            fmt::format("--shard {}: {} is a folder, which has its shard; allowed: with a job file",
                        o->shard, o->job.string())}});
    }
    const JobFolder folder =
        is_folder ? JobFolder(folder_path(o->job)) : folder_for(o->job, o->out, o->shard);
    if (o->again) start_again(folder);
    code = render_folder(folder, *o);
  });
}

}  // namespace lacuna
