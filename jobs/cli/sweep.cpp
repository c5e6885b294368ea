#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <chrono>
#include <csignal>
#include <deque>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "base/storage/atomic_file.h"
#include "base/storage/passing_error.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/render_job.h"
#include "jobs/cli/render_process.h"
#include "jobs/cli/results_folder.h"
#include "jobs/cli/slurm_sweep.h"
#include "jobs/cli/terminal.h"
#include "jobs/run/input_check.h"
#include "jobs/run/run_job.h"
#include "jobs/slurm/request.h"
#include "jobs/slurm/run_program.h"
#include "jobs/slurm/submission.h"
#include "jobs/spec/problems.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds longest_pause{30};

struct SweepOptions {
  fs::path what, out;
  std::string index;
  int jobs = 1, threads = -1;
  bool on_slurm = false;
  SlurmSweepSettings slurm;
  bool list = false, missing = false, quiet = false;
};

SweepFolder open(const SweepOptions& o) {
  if (fs::is_directory(o.what)) return SweepFolder(o.what);
  const fs::path out = results_folder(o.what, o.out, ".sweep");
  const SweepSpec spec = parse_sweep(read_file(o.what, max_sweep_bytes));
  return o.list || o.missing ? SweepFolder::preview(out, spec) : SweepFolder::create(out, spec);
}

/// Indices of runs as index_ranges() writes them, sorted. Throws BadJob.
std::set<std::size_t> parse_indices(const std::string& text, std::size_t runs) {
  const auto refuse = [&](const std::string& what) {
    throw BadJob({{"", fmt::format("--index {}: {}", text, what)}});
  };
  std::set<std::size_t> indices;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    std::size_t first = 0, last = 0;
    const char* end = part.data() + part.size();
    auto read = std::from_chars(part.data(), end, first);
    last = first;
    if (read.ec == std::errc() && read.ptr != end && *read.ptr == '-') {
      read = std::from_chars(read.ptr + 1, end, last);
    }
    if (read.ec != std::errc() || read.ptr != end || first < 1 || last < first) {
      refuse("allowed: indices and ranges of them, such as 1,4-7");
    }
    if (last > runs) refuse(fmt::format("the sweep has runs 1 to {}", runs));
    for (std::size_t i = first; i <= last; ++i) indices.insert(i);
  }
  return indices;
}

void print_runs(const SweepFolder& sweep) {
  fmt::print("{:>6} {:<12} {:<12} {}\n", "INDEX", "RUN", "STATE", "SETTINGS");
  for (std::size_t i = 0; i < sweep.plan().runs.size(); ++i) {
    const SweepRun& run = sweep.plan().runs[i];
    fmt::print("{:>6} {:<12} {:<12} {}\n", i + 1, run.name, enum_name(sweep.state(run).state),
               cell_text(sweep.plan().cells[run.cell].settings));
  }
}

/// A renderer with this exit code met what may pass: it was interrupted by nobody, never began (as
/// shells and the dynamic loader say it), or a file in its memory is cut off.
bool met_passing_fault(int code) {
  return code == exit_interrupted || code == 126 || code == 127 || code == 128 + SIGBUS;
}

/// Does the runs that are left, so many at a time. After a fault that may pass the run waits and
/// with it the others: pauses that double, and no longer than until one would be the longest.
class Runner {
 public:
  Runner(const SweepFolder& sweep, const SweepOptions& o)
      : sweep_(sweep), options_(o), terminal_({}, o.quiet) {}

  int run(const std::vector<std::size_t>& indices) {
    left_.assign(indices.begin(), indices.end());
    all_ = left_.size();
    bool stopping = false;
    while (!running_.empty() || (!left_.empty() && !ends())) {
      while (may_start()) start();
      if (interrupted_() && !std::exchange(stopping, true)) {
        for (const Running& r : running_) r.process.terminate();
      }
      collect();
      show();
    }
    terminal_.status({});
    if (!ends()) return failed_ == 0 ? exit_done : exit_error;
    const std::string why = interrupted_() ? "interrupted" : "given up: " + fault_;
    terminal_.milestone(why + "; the same command continues from here");
    return exit_interrupted;
  }

 private:
  struct Running {
    std::size_t index;
    RenderProcess process;
  };

  const SweepRun& run_at(std::size_t index) const { return sweep_.plan().runs[index - 1]; }

  bool ends() const { return interrupted_() || pause() == longest_pause; }

  std::chrono::milliseconds pause() const { return pause_after_fault(faults_, longest_pause); }

  bool may_start() const {
    return !ends() && !left_.empty() && running_.size() < static_cast<std::size_t>(options_.jobs) &&
           (faults_ == 0 || Clock::now() >= fault_time_ + pause());
  }

  void start() {
    const std::size_t index = left_.front();
    left_.pop_front();
    try {
      running_.push_back(
          {index, RenderProcess(sweep_.make_folder(run_at(index)), options_.threads)});
      // The next one's folder while this one loads: nobody has to wait for the disk then.
      if (!left_.empty()) sweep_.make_folder(run_at(left_.front()));
    } catch (const std::exception& error) {
      if (!may_pass(error)) throw;
      const bool started = !running_.empty() && running_.back().index == index;
      if (!started) postpone(index, error.what());
    }
  }

  void postpone(std::size_t index, const std::string& fault) {
    left_.push_front(index);
    if (faults_ == 0 || Clock::now() >= fault_time_ + pause()) {  // else one with those before
      ++faults_;
      fault_time_ = Clock::now();
    }
    if (std::exchange(fault_, fault) != fault) terminal_.warning("runs wait: " + fault);
  }

  /// Waits a little for one that ends.
  void collect() {
    for (auto it = running_.begin(); it != running_.end(); ++it) {
      const auto code = it->process.ended();
      if (!code) continue;
      const std::size_t index = it->index;
      running_.erase(it);
      return finish(index, *code);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  void finish(std::size_t index, int code) {
    const SweepRun& run = run_at(index);
    JobState state;
    try {
      state = sweep_.state(run);
    } catch (const std::exception& error) {
      if (!may_pass(error)) throw;
      return postpone(index, error.what());
    }
    const bool over = state.state == State::done || state.state == State::failed;
    if (!over && met_passing_fault(code) && !interrupted_()) {
      const std::string fault =
          fmt::format("{}: its renderer ended with exit code {}", run.name, code);
      return postpone(index, state.error.empty() ? fault : state.error);
    }
    ++finished_;
    const std::string text =
        fmt::format("[{}/{}] {} {}: {}", finished_, all_, run.name,
                    cell_text(sweep_.plan().cells[run.cell].settings), enum_name(state.state));
    if (state.state == State::done) {
      faults_ = 0;
      terminal_.milestone(text);
    } else if (!interrupted_()) {
      ++failed_;
      terminal_.error(text + (state.error.empty() ? "" : ": " + state.error));
    }
  }

  void show() {
    const auto now = Clock::now();
    if (!terminal_.shows_status() || now < next_show_) return;
    next_show_ = now + std::chrono::milliseconds(200);
    double share = static_cast<double>(finished_);
    for (const Running& r : running_) {
      const auto progress = sweep_.folder(run_at(r.index)).read_progress();
      if (progress) share += progress->share;
    }
    const double seconds = std::chrono::duration<double>(now - began_).count();
    const double rest = share > 0 ? seconds * (static_cast<double>(all_) - share) / share : 0;
    terminal_.status(fmt::format("{} of {} runs, {} failed, {:.0f} %, {:.0f} s left", finished_,
                                 all_, failed_, 100 * share / static_cast<double>(all_), rest));
  }

  const SweepFolder& sweep_;
  const SweepOptions& options_;
  const std::function<bool()>& interrupted_ = interrupt_requested();
  Terminal terminal_;
  std::deque<std::size_t> left_;
  std::vector<Running> running_;
  std::size_t all_ = 0, finished_ = 0, failed_ = 0;
  int faults_ = 0;  // in a row
  std::string fault_;
  Clock::time_point fault_time_;
  const Clock::time_point began_ = Clock::now();
  Clock::time_point next_show_;
};

std::vector<std::size_t> indices_of(const std::map<std::size_t, JobState>& runs) {
  std::vector<std::size_t> indices;
  for (const auto& [index, state] : runs) indices.push_back(index);
  return indices;
}

/// The runs that are left to do: what is not done, and what was made from other files than there
/// are now.
class LeftRuns {
 public:
  LeftRuns(const SweepFolder& folder, std::set<std::size_t> wanted, Terminal& terminal)
      : folder_(folder), wanted_(std::move(wanted)), terminal_(terminal) {}

  /// By their indices. Runs of changed inputs are told, and, unless only `looking`, begin anew.
  std::map<std::size_t, JobState> find(bool looking) {
    std::map<std::size_t, JobState> left;
    std::size_t unrecorded = 0;
    InputCheck check(DataRoot::from_environment(), ScenesRoots::from_environment());
    for (std::size_t i = 1; i <= folder_.plan().runs.size(); ++i) {
      if (!wanted_.empty() && !wanted_.contains(i)) continue;
      const SweepRun& run = folder_.plan().runs[i - 1];
      JobState state = folder_.state(run);
      if (is_stale(run, state, check, unrecorded) && (looking || start_anew(run))) {
        state.state = State::queued;
      }
      if (state.state != State::done) left.emplace(i, std::move(state));
    }
    if (unrecorded > 0 && !std::exchange(told_, true)) {
      terminal_.warning(fmt::format("{} runs: {}", unrecorded, inputs_not_recorded));
    }
    return left;
  }

 private:
  bool is_stale(const SweepRun& run, const JobState& state, InputCheck& check,
                std::size_t& unrecorded) {
    if (state.created.empty()) return false;  // not made yet
    const auto changes = check.changes(folder_.folder(run));
    if (!changes) {
      ++unrecorded;
      return false;
    }
    if (changes->empty()) return false;
    terminal_.warning(fmt::format("{} was rendered from other files ({}): it is rendered anew",
                                  run.name, fmt::join(*changes, "; ")));
    return true;
  }

  /// False: another process has it.
  bool start_anew(const SweepRun& run) {
    try {
      start_again(folder_.folder(run));
      return true;
    } catch (const FolderBusy& e) {
      terminal_.warning(e.what());
      return false;
    }
  }

  const SweepFolder& folder_;
  const std::set<std::size_t> wanted_;
  Terminal& terminal_;
  bool told_ = false;  // that some runs did not record their inputs
};

int run_on_slurm(const SweepFolder& folder, const SweepOptions& o,
                 const std::map<std::size_t, JobState>& left) {
  check_slurm_programs("--executor slurm");
  Terminal terminal({}, o.quiet);
  return SlurmSweep(folder, o.slurm, spawning_runner(), terminal).run(left, interrupt_requested());
}

/// Two executors would render the same runs at once.
void check_not_submitted(const SweepFolder& folder) {
  const auto submission = read_submission(JobFolder(folder.dir()));
  if (!submission) return;
  throw BadJob(
      {{"", fmt::format("{}: its runs are submitted to Slurm{}; allowed: to go on with "
                        "--executor slurm, also after scancel",
                        folder.dir().string(),
                        submission->job > 0 ? fmt::format(" as job {}", submission->job) : "")}});
}

int sweep(const SweepOptions& o) {
  const SweepFolder folder = open(o);
  const auto& runs = folder.plan().runs;
  if (folder.is_served() && !o.list && !o.missing) {
    throw BadJob({{"", fmt::format("{} is a sweep of a service, which does its runs; from here: "
                                   "--list, --missing",
                                   folder.dir().string())}});
  }
  if (o.list) return print_runs(folder), exit_done;
  Terminal terminal({}, o.quiet);
  LeftRuns left_runs(folder, parse_indices(o.index, runs.size()), terminal);
  if (o.missing) {
    return fmt::print("{}\n", index_ranges(indices_of(left_runs.find(true)))), exit_done;
  }
  // Tasks of an array do parts of it.
  if (!o.on_slurm && o.index.empty()) check_not_submitted(folder);
  const auto run = [&](const std::map<std::size_t, JobState>& left) {
    return o.on_slurm ? run_on_slurm(folder, o, left) : Runner(folder, o).run(indices_of(left));
  };
  int code = run(left_runs.find(false));
  // What changed meanwhile would mix two contents in one report.
  while (code == exit_done) {
    const auto left = left_runs.find(false);
    if (left.empty()) break;
    code = run(left);
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
  if (command.count("--jobs") > 0) o.slurm.tasks_at_a_time = o.jobs;
}

void add_slurm_options(CLI::App& command, SweepOptions& o) {
  command
      .add_option_function<std::string>(
          "--executor", [&o](const std::string& name) { o.on_slurm = name == "slurm"; },
          "who renders: local (this machine) or slurm (an array, from a folder that all nodes "
          "share)")
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
          "further options of sbatch, for example \"--partition=long --account=me\"; they win "
          "over those that follow from the runs")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--slurm-cores", o.slurm.cores,
                  "cores in Slurm of a run that names no threads; 0: a node of its own")
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
  command
      .add_option("--chunk", o.slurm.chunk,
                  "runs of each task of the array, one after another (default: as few as make at "
                  "most 1000 tasks)")
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
      ->add_option("-j,--jobs", o->jobs,
                   "runs at a time; more than one disturb each other's timings")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command
      ->add_option("-t,--threads", o->threads,
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
