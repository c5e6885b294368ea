#include "jobs/cli/slurm_sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "base/storage/atomic_file.h"
#include "jobs/cli/terminal.h"
#include "jobs/slurm/submission.h"
#include "jobs/spec/problems.h"
#include "jobs/store/exit_code.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using Phase = SlurmJob::Phase;

constexpr std::size_t most_tasks = 1000;    // what clusters allow by default (MaxArraySize 1001)
constexpr std::size_t looks_at_once = 256;  // at runs' folders, between two calls of squeue
constexpr int most_fruitless = 3;           // submissions that bring nothing
constexpr int grace_seconds = 30;           // before the time limit, for the checkpoints

std::uint64_t scene_bytes(const ScenesRoots& scenes, const std::string& name) {
  for (const auto& root : scenes.roots()) {
    std::error_code unknown;
    const auto bytes = fs::file_size(root / name, unknown);
    if (!unknown) return bytes;
  }
  return 0;
}

std::vector<std::string> environment(const ScenesRoots& scenes) {
  const DataRoot data = DataRoot::from_environment();
  std::vector<std::string> roots;
  for (const fs::path& root : scenes.roots()) roots.push_back(fs::absolute(root).string());
  return {"LACUNA_DATA=" + data.dir.string(), "LACUNA_CACHE=" + data.cache().string(),
          fmt::format("LACUNA_SCENES={}", fmt::join(roots, ":")),
          fmt::format("LACUNA_GRACE={}", grace_seconds)};
}

/// "2 TIMEOUT, 1 NODE_FAIL": how tasks ended.
std::string endings(const std::vector<SlurmJob>& tasks) {
  std::map<std::string, int> counts;
  for (const SlurmJob& task : tasks) ++counts[task.state];
  std::vector<std::string> texts;
  for (const auto& [state, n] : counts) texts.push_back(fmt::format("{} {}", n, state));
  return texts.empty() ? "Slurm does not know it any more"
                       : fmt::format("{}", fmt::join(texts, ", "));
}

bool any_is(const std::vector<SlurmJob>& tasks, std::string_view state) {
  return std::any_of(tasks.begin(), tasks.end(),
                     [&](const SlurmJob& task) { return task.state == state; });
}

}  // namespace

std::string index_ranges(const std::vector<std::size_t>& indices) {
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

SlurmSweep::SlurmSweep(const SweepFolder& sweep, SlurmSweepSettings settings, RunProgram run,
                       Terminal& terminal)
    : sweep_(sweep),
      settings_(std::move(settings)),
      programs_(std::move(run)),
      terminal_(terminal),
      record_(sweep.dir()) {
  slurm_path(sweep.dir());
}

int SlurmSweep::run(const std::map<std::size_t, JobState>& runs,
                    const std::function<bool()>& interrupted) {
  const auto alone = FileLock::try_take(record_.file(".slurm.lock"));
  if (!alone) {
    throw BadJob({{"", fmt::format("another process submits and follows the runs of {}; allowed: "
                                   "one at a time",
                                   sweep_.dir().string())}});
  }
  for (const auto& [index, state] : runs) {
    open_.push_back(index);
    attempts_[index] = state.attempts;
  }
  all_ = open_.size();
  if (const auto earlier = read_submission(record_)) {
    name_ = earlier->name;
    job_ = earlier->job;
    terminal_.milestone(job_ == 0
                            ? "an earlier submission is looked up by its name"
                            : fmt::format("Slurm job {} of an earlier command goes on", job_));
  }
  reached_ = progress();
  while (!open_.empty() || !name_.empty()) {
    if (name_.empty()) submit();
    if (!follow(interrupted)) {
      terminal_.milestone(fmt::format(
          "interrupted; {} goes on in Slurm, and the same command follows it (scancel ends it)",
          job_ == 0 ? name_ : fmt::format("job {}", job_)));
      return exit_interrupted;
    }
    if (fruitless_ == most_fruitless) return exit_error;
  }
  return failed_ == 0 ? exit_done : exit_error;
}

std::vector<std::string> SlurmSweep::words(std::size_t tasks,
                                           const std::vector<std::string>& request) const {
  std::vector<std::string> words{
      "--job-name=" + name_, "--output=" + slurm_path(record_.file("log.txt")),
      "--open-mode=append",  "--chdir=" + fs::current_path().string(),
      "--requeue",           fmt::format("--signal=B:TERM@{}", grace_seconds)};
  std::string array = fmt::format("--array=1-{}", tasks);
  if (settings_.tasks_at_a_time > 0) array += fmt::format("%{}", settings_.tasks_at_a_time);
  words.push_back(std::move(array));
  words.insert(words.end(), request.begin(), request.end());
  words.insert(words.end(), settings_.arguments.begin(), settings_.arguments.end());
  words.push_back(record_.file("slurm.sh").string());
  return words;
}

/// The runs that are open, dealt to tasks, and what the tasks ask for: each the same.
SlurmRequest SlurmSweep::deal(SlurmArrayScript& script, const ScenesRoots& scenes) const {
  const std::size_t chunk =
      settings_.chunk > 0 ? settings_.chunk : (open_.size() + most_tasks - 1) / most_tasks;
  std::vector<SlurmRequest> requests;
  std::optional<int> minutes = 0;
  for (std::size_t begin = 0; begin < open_.size(); begin += chunk) {
    const std::vector<std::size_t> task(
        open_.begin() + static_cast<std::ptrdiff_t>(begin),
        open_.begin() + static_cast<std::ptrdiff_t>(std::min(begin + chunk, open_.size())));
    std::vector<SlurmRequest> of_task;
    for (const std::size_t index : task) {
      const JobSpec& spec = sweep_.plan().cells[sweep_.plan().runs[index - 1].cell].job;
      script.all_cores = script.all_cores && spec.threads == 0;
      of_task.push_back(slurm_request(spec, {.cores = settings_.cores,
                                             .memory_limit = 0,
                                             .scene_bytes = scene_bytes(scenes, spec.scene),
                                             .priority = max_priority,
                                             .shortages = shortages_}));
    }
    script.tasks.push_back(index_ranges(task));
    requests.push_back(joint_request(of_task));
    const auto& more = requests.back().minutes;
    minutes = minutes && more ? std::optional(std::max(*minutes, *more)) : std::nullopt;
  }
  SlurmRequest request = joint_request(requests);
  request.minutes = minutes;  // tasks render side by side
  return request;
}

/// Writes down what is about to be submitted, and submits it. Throws std::system_error: nothing was
/// submitted.
void SlurmSweep::submit() {
  const ScenesRoots scenes = ScenesRoots::from_environment();
  SlurmArrayScript script{.name = new_submission_name(record_),
                          .sweep = sweep_.dir(),
                          .renderer = fs::read_symlink("/proc/self/exe"),
                          .directory = fs::current_path(),
                          .environment = environment(scenes),
                          .tasks = {},
                          .all_cores = true};
  const SlurmRequest request = deal(script, scenes);
  write_file_atomically(record_.file("slurm.sh"), array_script_text(script));
  Submission submission{script.name, 0, utc_now()};
  write_submission(record_, submission);
  name_ = script.name;
  job_ = 0;
  said_.clear();
  try {
    job_ = submission.job = programs_.submit(words(script.tasks.size(), request_words(request)));
    terminal_.milestone(fmt::format("{} runs are submitted as Slurm job {}, {} tasks", open_.size(),
                                    job_, script.tasks.size()));
    write_submission(record_, submission);
  } catch (const std::system_error&) {
    if (job_ == 0) forget_submission(record_);
    throw;
  } catch (const SlurmError& error) {  // there may be a job: it is looked up
    said_ = error.what();
  }
}

/// Until the submission is over. False: interrupted.
bool SlurmSweep::follow(const std::function<bool()>& interrupted) {
  Seen seen;
  constexpr std::chrono::milliseconds tick{100};
  auto next_list = std::chrono::steady_clock::now();
  do {
    look_at_runs(looks_at_once);
    if (open_.empty()) break;  // the folders say so, whatever Slurm does
    next_list = std::max(next_list, std::chrono::steady_clock::now());
    if (list(seen) && is_over(seen)) break;
    next_list += settings_.poll;
    while (std::chrono::steady_clock::now() < next_list) {
      if (interrupted()) return false;
      std::this_thread::sleep_for(std::min(tick, settings_.poll));
    }
  } while (!interrupted());
  if (interrupted()) return false;
  look_at_runs(open_.size());
  forget_submission(record_);
  name_.clear();
  if (!judge(seen)) fruitless_ = most_fruitless;
  return true;
}

/// Asks squeue once. False: no answer.
bool SlurmSweep::list(Seen& seen) {
  std::vector<SlurmJob> jobs;
  try {
    jobs = programs_.list();
    trouble_.clear();
  } catch (const std::exception& error) {  // squeue says no, or could not be called
    if (std::exchange(trouble_, error.what()) != trouble_) terminal_.warning(trouble_);
    return false;
  }
  std::erase_if(jobs, [&](const SlurmJob& job) { return job.name != name_; });
  const bool alive = std::any_of(jobs.begin(), jobs.end(),
                                 [](const SlurmJob& job) { return job.phase != Phase::over; });
  seen.gone = alive ? 0 : seen.gone + 1;
  if (jobs.empty()) return true;
  seen.listed = true;
  if (job_ == 0) {
    job_ = jobs.front().id;
    write_submission(record_, {name_, job_, utc_now()});
  }
  std::erase_if(jobs, [](const SlurmJob& job) { return job.phase != Phase::over; });
  seen.ended = std::move(jobs);
  return true;
}

bool SlurmSweep::is_over(const Seen& seen) const {
  if (seen.gone < slurm_listings_to_believe) return false;
  const bool never = !seen.listed && job_ == 0;
  return never || seen.gone >= slurm_listings_to_believe + slurm_intervals_to_lag;
}

/// After a submission. False: another one would be of no use, and why is told.
bool SlurmSweep::judge(const Seen& seen) {
  const std::int64_t reached = progress();
  fruitless_ = reached > reached_ ? 0 : fruitless_ + 1;
  reached_ = reached;
  if (open_.empty()) return true;
  if (job_ == 0) {
    if (said_.empty()) {
      terminal_.warning("the earlier submission had not reached Slurm");
    } else {
      terminal_.error(said_);
    }
    return said_.empty();
  }
  const std::string how =
      fmt::format("Slurm job {} left {} runs undone: {}", job_, open_.size(), endings(seen.ended));
  if (any_is(seen.ended, "CANCELLED")) {
    terminal_.error(how + "; the same command submits them again");
    return false;
  }
  if (any_is(seen.ended, "OUT_OF_MEMORY")) ++shortages_;
  if (fruitless_ < most_fruitless) {
    terminal_.warning(how + "; they are submitted again");
  } else {
    terminal_.error(fmt::format("{}; {} submissions brought nothing: {} tells more", how,
                                most_fruitless, record_.file("log.txt").string()));
  }
  return true;
}

/// At so many of the runs that are not over, in turn. One that had failed before it was submitted
/// has failed again once a further renderer says so.
void SlurmSweep::look_at_runs(std::size_t most) {
  std::set<std::size_t> over;
  for (std::size_t n = std::min(most, open_.size()); n > 0; --n) {
    const std::size_t index = open_[looked_++ % open_.size()];
    try {
      const JobState state = sweep_.state(sweep_.plan().runs[index - 1]);
      const bool failed = state.state == State::failed && state.attempts > attempts_[index];
      if ((failed || state.state == State::done) && over.insert(index).second) {
        report(index, state);
      }
    } catch (const std::exception&) {  // it lags, or is damaged, which its renderer finds out
    }
  }
  std::erase_if(open_, [&](std::size_t index) { return over.contains(index); });
}

void SlurmSweep::report(std::size_t index, const JobState& state) {
  const SweepRun& run = sweep_.plan().runs[index - 1];
  const std::string text =
      fmt::format("[{}/{}] {} {}: {}", ++finished_, all_, run.name,
                  cell_text(sweep_.plan().cells[run.cell].settings), enum_name(state.state));
  if (state.state == State::done) return terminal_.milestone(text);
  ++failed_;
  terminal_.error(text + (state.error.empty() ? "" : ": " + state.error));
}

/// Grows with each run that is over, and with the iterations of others.
std::int64_t SlurmSweep::progress() const {
  constexpr std::int64_t of_a_run = std::int64_t{1} << 40;
  std::int64_t sum = of_a_run * static_cast<std::int64_t>(finished_);
  for (std::size_t i = 0; i < std::min(open_.size(), looks_at_once); ++i) {
    const auto seen = sweep_.folder(sweep_.plan().runs[open_[i] - 1]).read_progress();
    if (seen) sum += seen->iteration;
  }
  return sum;
}

}  // namespace lacuna
