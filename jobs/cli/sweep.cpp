#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

#include "base/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/left_runs.h"
#include "jobs/cli/results_folder.h"
#include "jobs/cli/sweep_queue.h"
#include "jobs/cli/terminal.h"
#include "jobs/queue/submission.h"
#include "jobs/slurm/request.h"
#include "jobs/spec/problems.h"
#include "jobs/store/exit_code.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

struct SweepOptions {
  fs::path what, out;
  std::string index;
  SweepQueueSettings queue;
  SlurmSettings slurm;
  bool on_slurm = false;
  std::size_t chunk = 0;
  bool list = false, missing = false, quiet = false;
};

SweepFolder open(const SweepOptions& o) {
  if (fs::is_directory(o.what)) return SweepFolder(o.what);
  const fs::path out = results_folder(o.what, o.out, ".sweep");
  const SweepSpec spec = parse_sweep(read_file(o.what, max_sweep_bytes));
  return o.list || o.missing ? SweepFolder::preview(out, spec) : SweepFolder::create(out, spec);
}

void print_runs(const SweepFolder& sweep) {
  fmt::print("{:>6} {:<12} {:<12} {}\n", "INDEX", "RUN", "STATE", "SETTINGS");
  for (std::size_t i = 0; i < sweep.plan().runs.size(); ++i) {
    const SweepRun& run = sweep.plan().runs[i];
    fmt::print("{:>6} {:<12} {:<12} {}\n", i + 1, run.name, enum_name(sweep.state(run).state),
               cell_text(sweep.plan().cells[run.cell].settings));
  }
}

std::vector<std::size_t> indices_of(const std::map<std::size_t, JobState>& runs) {
  std::vector<std::size_t> indices;
  indices.reserve(runs.size());
  for (const auto& [index, state] : runs) indices.push_back(index);
  return indices;
}

/// Refuses runs that another executor may be rendering.
void check_not_submitted(const SweepFolder& folder, bool on_slurm) {
  const auto refuse = [](const JobFolder& job, const std::string& allowed) {
    const auto submission = read_submission(job);
    if (!submission) return;
    const std::string number =
        submission->job > 0 ? fmt::format(" as job {}", submission->job) : "";
    throw BadJob({{"", fmt::format("{} is submitted to Slurm{}; allowed: {}", job.dir().string(),
                                   number, allowed)}});
  };
  refuse(JobFolder(folder.dir()),
         "to wait for this array of an earlier version or to scancel it, and then to remove "
         "slurm.json");
  if (on_slurm) return;
  for (const SweepRun& run : folder.plan().runs) {
    refuse(folder.folder(run), "to continue with --executor slurm, also after scancel");
  }
}

int sweep(const SweepOptions& o) {
  const SweepFolder folder = open(o);
  const auto& runs = folder.plan().runs;
  if (folder.is_served() && !o.list && !o.missing) {
    throw BadJob(
        {{"", fmt::format(
                  "{} is a sweep of a service, which renders its runs; allowed: --list, --missing",
                  folder.dir().string())}});
  }
  if (o.list) return print_runs(folder), exit_done;
  Terminal terminal({}, o.quiet);
  LeftRuns left_runs(folder, parse_indices(o.index, runs.size()), terminal);
  if (o.missing) {
    return fmt::print("{}\n", index_ranges(indices_of(left_runs.find(true)))), exit_done;
  }
  if (o.chunk > 0) {
    terminal.warning("--chunk has no effect: each run is a separate Slurm job");
  }
  // Array tasks render parts of it.
  if (o.index.empty()) check_not_submitted(folder, o.on_slurm);
  std::map<std::size_t, JobState> left = left_runs.find(false);
  int code = exit_done;
  // Renders runs whose files changed meanwhile again: one report must not mix two contents.
  while (code == exit_done && !left.empty()) {
    code = SweepQueue(folder, o.queue, terminal).run(left, interrupt_requested());
    if (code == exit_done) left = left_runs.find(false);
  }
  if (o.index.empty()) {
    write_file_atomically(folder.dir() / "table.csv", sweep_table(folder));
    if (!o.quiet) {
      fmt::print(stderr, "`lacuna report {}` compares its cells\n", folder.dir().string());
    }
  }
  return code;
}

/// Options of one executor only. Throws CLI::ValidationError.
void check_executor(const CLI::App& command, SweepOptions& o) {
  const auto refuse = [&](const char* option, const char* why) {
    if (command.count(option) > 0) throw CLI::ValidationError(option, why);
  };
  if (!o.on_slurm) {
    for (const char* option : {"--slurm-args", "--slurm-poll", "--slurm-cores", "--chunk"}) {
      refuse(option, "needs --executor slurm");
    }
    return;
  }
  for (const char* option : {"--threads", "--index", "--list", "--missing"}) {
    refuse(option, "not with --executor slurm");
  }
  if (command.count("--jobs") == 0) o.queue.at_a_time = slurm_jobs_at_a_time;
  o.queue.slurm = o.slurm;
}

void add_slurm_options(CLI::App& command, SweepOptions& o) {
  command
      .add_option_function<std::string>(
          "--executor", [&o](const std::string& name) { o.on_slurm = name == "slurm"; },
          "where runs are rendered: local (this machine) or slurm (each run is a Slurm job, in a "
          "folder that all nodes share)")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->default_str("local");
  command
      .add_option_function<std::vector<std::string>>(
          "--slurm-args",
          [&o](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              try {
                for (std::string& word : slurm_arguments(text)) {
                  o.slurm.arguments.push_back(std::move(word));
                }
              } catch (const std::invalid_argument& error) {
                throw CLI::ValidationError("--slurm-args", error.what());
              }
            }
          },
          "further options of sbatch, for example \"--partition=long --account=me\"; they override "
          "those derived from the runs")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--slurm-cores", o.slurm.cores,
                  "cores in Slurm for a run that sets no threads; 0: an exclusive node")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command
      .add_option_function<double>(
          "--slurm-poll",
          [&o](double seconds) {
            o.slurm.poll = std::chrono::milliseconds(static_cast<std::int64_t>(1000 * seconds));
          },
          "seconds between two calls of squeue")
      ->check(CLI::Range(0.05, 3600.0))
      ->default_str("3");
  command.add_option("--chunk", o.chunk, "has no effect: each run is a separate Slurm job")
      ->check(CLI::PositiveNumber);
}

}  // namespace

void add_sweep(CLI::App& app, int& code) {
  const auto o = std::make_shared<SweepOptions>();
  CLI::App* command = app.add_subcommand(
      "sweep", "Render all runs of a sweep file that are not done; results: runs/, table.csv");
  command->add_option("SWEEP", o->what, "a sweep file (JSON), or a sweep's folder")
      ->required()
      ->check(existing_path);
  command->add_option("-o,--out", o->out, "folder for the results (default: NAME.sweep)");
  command
      ->add_option("-j,--jobs", o->queue.at_a_time,
                   "runs at a time; several on one machine disturb each other's timings; with "
                   "Slurm, runs submitted at a time, default 64")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command
      ->add_option("-t,--threads", o->queue.threads,
                   "number of threads instead of the jobs'; 0: one per core")
      ->check(CLI::Range(0, 1024));
  command->add_option("--index", o->index,
                      "only these runs, from 1, such as 1,4-7: for array tasks");
  command->add_flag("--list", o->list, "print all runs with their states and settings, and exit");
  command
      ->add_flag("--missing", o->missing,
                 "print the indices of runs that are not done, such as 1,4-7, and exit")
      ->excludes("--list");
  command->add_flag("-q,--quiet", o->quiet, "show warnings and errors only");
  add_slurm_options(*command, *o);
  command->callback([o, command, &code] {
    check_executor(*command, *o);
    code = sweep(*o);
  });
}

}  // namespace lacuna
