#include "jobs/cli/sweep_queue.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <utility>

#include "base/log/log.h"
#include "jobs/cli/interrupt.h"
#include "jobs/queue/executor_local.h"
#include "jobs/slurm/executor_slurm.h"
#include "jobs/spec/job_json.h"
#include "jobs/store/exit_code.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds default_grace{30};
constexpr std::chrono::minutes patience{1};
constexpr std::chrono::milliseconds tick{100}, look_at_slurm{2000}, show_again{200};

/// Time between SIGTERM and SIGKILL of a renderer.
std::chrono::milliseconds grace() {
  if (std::getenv("LACUNA_GRACE") == nullptr) return default_grace;
  return std::chrono::milliseconds(static_cast<std::int64_t>(1000 * stop_grace()));
}

std::unique_ptr<Executor> make_executor(const SweepQueueSettings& settings) {
  const DataRoot data = DataRoot::from_environment();
  ExecutorSettings common{.renderer = fs::read_symlink("/proc/self/exe"),
                          .directory = fs::current_path(),
                          .data = data.dir,
                          .cache = data.cache(),
                          .scenes = {},
                          .grace = grace(),
                          .limits = {}};
  const ScenesRoots scenes = ScenesRoots::from_environment();
  for (const fs::path& root : scenes.roots()) {
    common.scenes.push_back(fs::absolute(root));
  }
  if (settings.threads >= 0) common.options = {"--threads", std::to_string(settings.threads)};
  if (settings.slurm) return std::make_unique<SlurmExecutor>(std::move(common), *settings.slurm);
  return std::make_unique<LocalExecutor>(std::move(common));
}

}  // namespace

/// Log lines of the queue's threads.
struct SweepQueue::LogLines {
  std::mutex mutex;  // guards the next
  std::vector<std::string> lines;
};

SweepQueue::SweepQueue(const SweepFolder& sweep, const SweepQueueSettings& settings,
                       Terminal& terminal)
    : sweep_(sweep),
      terminal_(terminal),
      remote_(settings.slurm.has_value()),
      at_a_time_(settings.at_a_time),
      log_(std::make_shared<LogLines>()),
      store_(":memory:"),
      executor_(make_executor(settings)),
      disk_(sweep.dir(), 0),
      queue_(*executor_, store_, sweep.runs_dir(), disk_,
             {.children = settings.at_a_time, .grace = grace(), .lasting = false}) {
  log::start([log = log_](log::Level, std::string_view line) {
    const std::lock_guard lock(log->mutex);
    log->lines.emplace_back(line);
  });
}

int SweepQueue::run(const std::map<std::size_t, JobState>& left,
                    const std::function<bool()>& interrupted) {
  add(left);
  if (remote_) {
    terminal_.milestone(fmt::format("{} runs go to Slurm, at most {} at a time", all_, at_a_time_));
  }
  queue_.start();
  while (!open_.empty() && !interrupted() && !gives_up()) {
    take_events();
    look_after();
    show();
  }
  const bool gave_up = !interrupted() && !open_.empty();
  queue_.stop();
  take_events();
  print_log();
  terminal_.status({});
  if (open_.empty()) return failed_ == 0 ? exit_done : exit_error;
  terminal_.milestone(
      fmt::format("{}; {}the same command continues from here",
                  gave_up ? "gave up: " + obstacle_ : "interrupted",
                  remote_ ? "submitted runs continue in Slurm (scancel ends them), and " : ""));
  return exit_interrupted;
}

void SweepQueue::add(const std::map<std::size_t, JobState>& left) {
  all_ = left.size();
  store_.change([&](StoreChange& c) {
    for (const auto& [index, state] : left) {
      const SweepRun& run = sweep_.plan().runs[index - 1];
      const JobFolder folder = sweep_.folder(run);
      JobEntry job;
      job.id = run.name;
      if (fs::exists(folder.file("job.json"))) {  // a person may have extended it
        const std::string text = folder.read_job_text();
        take_spec(job, parse_job(text));
        job.spec = text;
      } else {
        take_spec(job, sweep_.plan().job_of(run));
      }
      job.state = state;
      job.state.state = State::queued;
      if (job.state.created.empty()) job.state.created = utc_now();
      job.reopened = is_terminal(state.state);
      c.add(job);
      open_[run.name] = &run;
    }
  });
}

/// Waits up to `tick` for events.
void SweepQueue::take_events() {
  const auto events = store_.journal().since(seen_, tick);
  if (!events) {  // some were discarded: read all runs
    seen_ = store_.journal().last();
    std::vector<std::string> names;
    for (const auto& [name, run] : open_) names.push_back(name);
    for (const std::string& name : names) take(*store_.find(name));
    return;
  }
  for (const JobEvent& event : *events) {
    seen_ = event.number;
    if (event.entry) take(*event.entry);
  }
}

void SweepQueue::take(const JobEntry& entry) {
  if (!open_.contains(entry.id)) return;
  if (!entry.obstacle.empty()) {
    obstacle_ = entry.obstacle;
    if (!since_) since_ = Clock::now();
  } else if (entry.over() || entry.progress) {
    since_.reset();
  }
  if (entry.over()) report(entry);
}

void SweepQueue::report(const JobEntry& entry) {
  const SweepRun& run = *open_.at(entry.id);
  open_.erase(entry.id);
  const std::string text =
      fmt::format("[{}/{}] {} {}: {}", ++finished_, all_, run.name,
                  cell_text(sweep_.plan().cells[run.cell].settings), enum_name(entry.state.state));
  if (entry.state.state == State::done) return terminal_.milestone(text);
  ++failed_;
  terminal_.error(text + (entry.state.error.empty() ? "" : ": " + entry.state.error));
}

void SweepQueue::print_log() {
  std::vector<std::string> lines;
  {
    const std::lock_guard lock(log_->mutex);
    lines.swap(log_->lines);
  }
  for (const std::string& line : lines) terminal_.warning(line);
}

void SweepQueue::look_after() {
  print_log();
  const auto now = Clock::now();
  const bool shows = terminal_.shows_status() || remote_;
  if (!shows || now < next_look_) return;
  next_look_ = now + (remote_ ? look_at_slurm : show_again);
  queue_.look_at_running();
  if (!remote_) return;
  const std::string why = queue_.obstacle();
  if (std::exchange(told_, why) != why && !why.empty()) terminal_.warning("runs wait: " + why);
}

void SweepQueue::show() {
  const auto now = Clock::now();
  if (!terminal_.shows_status() || now < next_show_) return;
  next_show_ = now + show_again;
  constexpr std::size_t most = 1024;  // at least --jobs
  double share = static_cast<double>(finished_);
  for (const JobEntry& entry : store_.unfinished(0, most)) {
    if (entry.begun && entry.progress) share += entry.progress->share;
  }
  const double seconds = std::chrono::duration<double>(now - began_).count();
  const double rest = share > 0 ? seconds * (static_cast<double>(all_) - share) / share : 0;
  terminal_.status(fmt::format("{} of {} runs, {} failed, {:.0f} %, {:.0f} s left", finished_, all_,
                               failed_, 100 * share / static_cast<double>(all_), rest));
}

/// Whether an obstacle has lasted so long that a person must remove it.
bool SweepQueue::gives_up() const { return since_ && Clock::now() - *since_ > patience; }

}  // namespace lacuna
