#include "jobs/slurm/executor_slurm.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "base/log/log.h"
#include "base/storage/atomic_file.h"
#include "jobs/queue/executor_local.h"
#include "jobs/slurm/request.h"
#include "jobs/slurm/run_program.h"
#include "jobs/slurm/script.h"

namespace lacuna {
namespace {

using Clock = SlurmWatch::Clock;

RunProgram checked_runner(const ExecutorSettings& settings) {
  check_slurm_programs("--executor slurm");
  return slurm_runner(settings.directory);
}

std::uint64_t scene_bytes(const ExecutorSettings& settings, const std::string& scene) {
  for (const auto& root : settings.scenes) {
    std::error_code unknown;
    const auto bytes = std::filesystem::file_size(root / scene, unknown);
    if (!unknown) return bytes;
  }
  return 0;
}

/// Waits until one of two descriptors is readable; negative `time`: no limit.
void wait_for(int one, int other, std::chrono::milliseconds time) {
  std::array<pollfd, 2> fds{{{one, POLLIN, 0}, {other, POLLIN, 0}}};
  ::poll(fds.data(), fds.size(), static_cast<int>(time.count()));
}

/// The ending of a submission that Slurm never had or refused.
Ending not_submitted(const std::string& said) {
  if (refuses_the_job(said)) return {Ending::Kind::refused, 0, said};
  return {Ending::Kind::not_started, EAGAIN,
          said.empty() ? "its submission did not reach Slurm" : said};
}

}  // namespace

/// Ends a job of Slurm as the service ends a child: SIGTERM, and after the grace period scancel,
/// which ends with SIGKILL. A waiting job is only removed from the queue. Each step is repeated
/// until Slurm reports the end: a request can be lost.
class SlurmExecutor::Stopping {
 public:
  Stopping(const SlurmPrograms& programs, std::chrono::milliseconds grace,
           std::chrono::milliseconds again)
      : programs_(programs), grace_(grace), again_(again) {}

  void go_on(const SlurmWatch::View& view) {
    const std::int64_t job = view.submission.job;
    if (job == 0 || Clock::now() < next_) return;  // once its number is known
    next_ = Clock::now() + again_;
    try {
      if (!view.last || view.last->phase == SlurmJob::Phase::waits) {
        programs_.cancel_if_waiting(job);
      } else if (view.last->phase == SlurmJob::Phase::runs) {
        if (!asked_) asked_ = Clock::now();
        if (Clock::now() - *asked_ < grace_) {
          if (!std::exchange(told_, true)) programs_.terminate(job);
        } else {
          programs_.cancel(job);
        }
      }
    } catch (const std::exception& error) {
      told_ = false;
      log::warn("Slurm job {} is not stopped yet: {}", job, error.what());
    }
  }

 private:
  const SlurmPrograms& programs_;
  const std::chrono::milliseconds grace_, again_;
  Clock::time_point next_{};
  std::optional<Clock::time_point> asked_;
  bool told_ = false;
};

SlurmExecutor::SlurmExecutor(ExecutorSettings settings, SlurmSettings slurm, RunProgram run)
    : settings_(std::move(settings)),
      slurm_(std::move(slurm)),
      environment_(renderer_environment(settings_)),
      programs_(run ? std::move(run) : checked_runner(settings_)),
      watch_(programs_, slurm_.poll) {
  check_renderer(settings_);
  slurm_path(settings_.directory);
}

Ending SlurmExecutor::run(const Task& task, const StopSignal& stop, const Notices& notices) {
  const JobFolder& folder = task.folder;
  Attempted attempted;
  try {
    if (const auto earlier = read_submission(folder)) {
      attempted.submission = *earlier;
    } else {
      const std::lock_guard one_at_a_time(submitting_);
      if (stop.leaves()) return {Ending::Kind::left, 0, "the service ends"};
      attempted = submit(task);
    }
  } catch (const std::system_error& error) {
    return folder_unusable(folder, error);
  }
  if (!attempted.called) return not_submitted(attempted.said);
  return follow(folder, std::move(attempted), stop, notices);
}

/// Records a submission and submits it. Throws std::system_error if the job's folder cannot be
/// written.
SlurmExecutor::Attempted SlurmExecutor::submit(const Task& task) {
  const JobFolder& folder = task.folder;
  Attempted attempted{{new_submission_name(folder), 0, utc_now()}, {}};
  const auto words = words_for(task, attempted.submission);
  write_submission(folder, attempted.submission);
  try {
    attempted.submission.job = programs_.submit(words);
    log::info("{}: submitted as Slurm job {}", folder.id(), attempted.submission.job);
    write_submission(folder, attempted.submission);
  } catch (const std::system_error& error) {
    if (attempted.submission.job != 0) throw;
    forget_submission(folder);
    return {{}, fmt::format("renderer could not be submitted: {}", error.what()), false};
  } catch (const SlurmError& error) {
    attempted.said = error.what();
    log::warn("{}: {}", folder.id(), attempted.said);
  }
  const std::lock_guard lock(mutex_);
  refusal_ = refuses_the_job(attempted.said) ? "" : attempted.said;
  return attempted;
}

std::vector<std::string> SlurmExecutor::words_for(const Task& task,
                                                  const Submission& submission) const {
  const JobFolder& folder = task.folder;
  const JobSpec spec = folder.read_job();
  const SlurmRequest request =
      slurm_request(spec, {.cores = slurm_.cores,
                           .memory_limit = settings_.limits.memory_bytes,
                           .scene_bytes = scene_bytes(settings_, spec.scene),
                           .priority = task.priority,
                           .shortages = task.crashes});
  const auto script = folder.file("slurm.sh");
  write_file_atomically(script, script_text({.name = submission.name,
                                             .folder = folder.dir(),
                                             .renderer = settings_.renderer,
                                             .directory = settings_.directory,
                                             .environment = environment_,
                                             .all_cores = spec.threads == 0}));
  std::vector<std::string> words{
      "--job-name=" + submission.name, "--output=" + slurm_path(folder.file("log.txt")),
      "--open-mode=append", "--chdir=" + settings_.directory.string(), "--requeue"};
  const double grace = std::ceil(static_cast<double>(settings_.grace.count()) / 1000);
  if (grace > 0) words.push_back(fmt::format("--signal=B:TERM@{:.0f}", grace));
  for (std::string& word : request_words(request)) words.push_back(std::move(word));
  words.insert(words.end(), slurm_.arguments.begin(), slurm_.arguments.end());
  words.push_back(script.string());
  return words;
}

/// Applies a priority that was changed while the job waits in Slurm.
void SlurmExecutor::show_priority(const SlurmWatch::View& view) const {
  if (!view.nice || !view.last || view.last->phase != SlurmJob::Phase::waits) return;
  try {
    programs_.set_nice(view.submission.job, *view.nice);
  } catch (const std::exception& error) {
    log::warn("Slurm job {} keeps its priority: {}", view.submission.job, error.what());
  }
}

/// Waits for the end of a submission of this or an earlier service.
Ending SlurmExecutor::follow(const JobFolder& folder, Attempted attempted, const StopSignal& stop,
                             const Notices& notices) {
  Submission& known = attempted.submission;
  const SlurmWatch::Guest guest(watch_, folder, known, notices.place);
  Stopping stopping(programs_, settings_.grace, slurm_.poll);
  bool told = false;
  for (;;) {
    const SlurmWatch::View view = guest.look();
    if (stop.leaves()) return {Ending::Kind::left, 0, "the service ends; its renderer continues"};
    if (view.submission.job != known.job) {
      known.job = view.submission.job;
      write_submission(folder, known);
    }
    if (known.job != 0 && !std::exchange(told, true) && notices.started) notices.started(0);
    if (view.unknown || view.ending) {
      forget_submission(folder);
      const bool lost = view.ending && view.ending->kind == Ending::Kind::lost;
      if (view.unknown || (lost && !attempted.said.empty())) return not_submitted(attempted.said);
      Ending ending = *view.ending;
      const bool ours = ending.kind == Ending::Kind::refused && stop.is_requested();
      if (ours) ending.kind = Ending::Kind::lost;
      return ending;
    }
    show_priority(view);
    if (stop.is_requested()) {
      stopping.go_on(view);
      constexpr std::chrono::milliseconds shortest{50};
      wait_for(guest.event(), -1, std::max(shortest, std::min(slurm_.poll, settings_.grace)));
    } else {
      wait_for(guest.event(), stop.fd(), std::chrono::milliseconds(-1));
    }
  }
}

void SlurmExecutor::set_priority(const JobFolder& folder, int priority) {
  watch_.set_nice(folder, slurm_nice(priority));
}

std::string SlurmExecutor::obstacle() const {
  if (std::string obstacle = watch_.obstacle(); !obstacle.empty()) return obstacle;
  const std::lock_guard lock(mutex_);
  return refusal_;
}

}  // namespace lacuna
