#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <deque>
#include <thread>
#include <utility>

#include "analysis/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/render_process.h"
#include "jobs/cli/results_folder.h"
#include "jobs/cli/terminal.h"
#include "jobs/spec/problems.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct SweepOptions {
  fs::path what, out;
  std::size_t index = 0;
  int jobs = 1, threads = -1;
  bool list = false, missing = false, quiet = false;
};

SweepFolder open(const SweepOptions& o) {
  if (fs::is_directory(o.what)) return SweepFolder(o.what);
  const fs::path out = results_folder(o.what, o.out, ".sweep");
  const SweepSpec spec = parse_sweep(read_file(o.what, max_sweep_bytes));
  return o.list || o.missing ? SweepFolder::preview(out, spec) : SweepFolder::create(out, spec);
}

/// "1,4-7,9": as array tasks are named.
std::string ranges(const std::vector<std::size_t>& indices) {
  std::string text;
  for (std::size_t i = 0; i < indices.size();) {
    std::size_t end = i;
    while (end + 1 < indices.size() && indices[end + 1] == indices[end] + 1) ++end;
    text += fmt::format("{}{}", text.empty() ? "" : ",", indices[i]);
    if (end > i) text += fmt::format("-{}", indices[end]);
    i = end + 1;
  }
  return text;
}

void print_runs(const SweepFolder& sweep) {
  fmt::print("{:>6} {:<12} {:<12} {}\n", "INDEX", "RUN", "STATE", "SETTINGS");
  for (std::size_t i = 0; i < sweep.plan().runs.size(); ++i) {
    const SweepRun& run = sweep.plan().runs[i];
    fmt::print("{:>6} {:<12} {:<12} {}\n", i + 1, run.name, enum_name(sweep.state(run).state),
               cell_text(sweep.plan().cells[run.cell].settings));
  }
}

/// Does the runs that are left, so many at a time.
class Runner {
 public:
  Runner(const SweepFolder& sweep, const SweepOptions& o)
      : sweep_(sweep), options_(o), terminal_({}, o.quiet) {}

  int run(const std::vector<std::size_t>& indices) {
    left_.assign(indices.begin(), indices.end());
    all_ = left_.size();
    const auto& interrupted = interrupt_requested();
    bool stopping = false;
    while (!running_.empty() || (!left_.empty() && !interrupted())) {
      while (!interrupted() && !left_.empty() &&
             running_.size() < static_cast<std::size_t>(options_.jobs)) {
        start();
      }
      if (interrupted() && !std::exchange(stopping, true)) {
        for (const Running& r : running_) r.process.terminate();
      }
      collect();
      show();
    }
    terminal_.status({});
    if (interrupted()) {
      terminal_.milestone("interrupted; the same command continues from here");
      return exit_interrupted;
    }
    return failed_ == 0 ? exit_done : exit_error;
  }

 private:
  struct Running {
    std::size_t index;
    RenderProcess process;
  };

  const SweepRun& run_at(std::size_t index) const { return sweep_.plan().runs[index - 1]; }

  void start() {
    const std::size_t index = left_.front();
    left_.pop_front();
    running_.push_back({index, RenderProcess(sweep_.make_folder(run_at(index)), options_.threads)});
    // The next one's folder while this one loads: nobody has to wait for the disk then.
    if (!left_.empty()) sweep_.make_folder(run_at(left_.front()));
  }

  /// Waits a little for one that ends.
  void collect() {
    for (auto it = running_.begin(); it != running_.end(); ++it) {
      if (!it->process.ended()) continue;
      finish(it->index);
      running_.erase(it);
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  void finish(std::size_t index) {
    const SweepRun& run = run_at(index);
    const JobState state = sweep_.state(run);
    ++finished_;
    const std::string text =
        fmt::format("[{}/{}] {} {}: {}", finished_, all_, run.name,
                    cell_text(sweep_.plan().cells[run.cell].settings), enum_name(state.state));
    if (state.state == State::done) {
      terminal_.milestone(text);
    } else if (!interrupt_requested()()) {
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
  Terminal terminal_;
  std::deque<std::size_t> left_;
  std::vector<Running> running_;
  std::size_t all_ = 0, finished_ = 0, failed_ = 0;
  const Clock::time_point began_ = Clock::now();
  Clock::time_point next_show_;
};

int sweep(const SweepOptions& o) {
  const SweepFolder folder = open(o);
  const auto& runs = folder.plan().runs;
  if (folder.is_served() && !o.list && !o.missing) {
    throw BadJob({{"", fmt::format("{} is a sweep of a service, which does its runs; from here: "
                                   "--list, --missing",
                                   folder.dir().string())}});
  }
  if (o.list) return print_runs(folder), exit_done;
  std::vector<std::size_t> left;
  for (std::size_t i = 1; i <= runs.size(); ++i) {
    if (o.index != 0 && o.index != i) continue;
    if (folder.state(runs[i - 1]).state != State::done) left.push_back(i);
  }
  if (o.missing) return fmt::print("{}\n", ranges(left)), exit_done;
  if (o.index > runs.size()) {
    throw BadJob(
        {{"", fmt::format("--index {}: the sweep has runs 1 to {}", o.index, runs.size())}});
  }
  const int code = Runner(folder, o).run(left);
  if (o.index == 0) {
    write_file_atomically(folder.dir() / "table.csv", sweep_table(folder));
    if (!o.quiet) {
      fmt::print(stderr, "`lacuna report {}` compares its cells\n", folder.dir().string());
    }
  }
  return code;
}

}  // namespace

void add_sweep(CLI::App& app, int& code) {
  const auto o = std::make_shared<SweepOptions>();
  CLI::App* command = app.add_subcommand(
      "sweep", "Render all runs of a sweep file that are not done; results: runs/, table.csv");
  command->add_option("SWEEP", o->what, "a sweep file (JSON), or a sweep's folder")
      ->required()
      ->check(CLI::ExistingPath);
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
  command->add_option("--index", o->index, "only this run, from 1: for array tasks")
      ->check(CLI::PositiveNumber);
  command->add_flag("--list", o->list, "print all runs with their states and settings, and exit");
  command
      ->add_flag("--missing", o->missing,
                 "print the indices of runs that are not done, such as 1,4-7, and exit")
      ->excludes("--list");
  command->add_flag("-q,--quiet", o->quiet, "show warnings and errors only");
  command->callback([o, &code] { code = sweep(*o); });
}

}  // namespace lacuna
