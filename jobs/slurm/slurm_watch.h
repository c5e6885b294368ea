#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "base/storage/file_handle.h"
#include "jobs/queue/executor.h"
#include "jobs/queue/submission.h"
#include "jobs/slurm/slurm_programs.h"

namespace lacuna {

/// How the job of a submission ended, by its folder and, where that says nothing, by Slurm.
/// `code`: as read_submission_exit() has it. `last`: what Slurm said last, if it ever did.
Ending slurm_ending(std::optional<int> code, const std::optional<SlurmJob>& last, bool known_now);

/// One submission that a runner waits for. Its members belong to the watch's lock.
struct SlurmWatched {
  using Clock = std::chrono::steady_clock;
  JobFolder folder;
  Submission submission;
  std::function<void(const std::string&)> place;
  FileHandle event;                        ///< readable when there is something new for the runner
  Clock::time_point since = Clock::now();  ///< listings that began earlier say nothing of it
  std::optional<SlurmJob> last = {};
  std::optional<Clock::time_point> gone_since = {};  ///< Slurm does not have it (any more)
  int gone = 0;                                      ///< listings that say so
  bool asked_accounts = false;
  bool unknown = false;               ///< Slurm has never had it
  std::optional<Ending> ending = {};  ///< it is over
  std::optional<int> nice = {};       ///< the runner shall set this one
};

/// Watches all submissions of this queue at once: their folders once a second, and squeue at most
/// once in each interval, however many there are.
class SlurmWatch {
 public:
  using Clock = std::chrono::steady_clock;

  SlurmWatch(const SlurmPrograms& programs, std::chrono::milliseconds poll);
  ~SlurmWatch();
  SlurmWatch(const SlurmWatch&) = delete;
  SlurmWatch& operator=(const SlurmWatch&) = delete;

  /// The runner's view of one of them.
  struct View {
    Submission submission;
    std::optional<SlurmJob> last;
    std::optional<Ending> ending;
    bool unknown = false;
    std::optional<int> nice;
  };

  /// A submission is watched as long as this lives.
  class Guest {
   public:
    /// Throws std::system_error: no descriptor is left.
    Guest(SlurmWatch& watch, const JobFolder& folder, const Submission& submission,
          std::function<void(const std::string&)> place);
    ~Guest();
    Guest(const Guest&) = delete;
    Guest& operator=(const Guest&) = delete;
    /// Its event is quiet again.
    View look() const;
    /// Readable when there is something new to see.
    int event() const { return watched_->event.get(); }

   private:
    SlurmWatch& watch_;
    std::shared_ptr<SlurmWatched> watched_;
  };

  /// The runner of this job, if there is one, shall set it.
  void set_nice(const JobFolder& folder, int nice);
  /// Why squeue could not be asked; empty: it could.
  std::string obstacle() const;

 private:
  using WatchedPtr = std::shared_ptr<SlurmWatched>;
  void run(const std::stop_token& ends);
  void list();
  void account(const std::vector<WatchedPtr>& whom);
  void judge(SlurmWatched& watched, bool listed);
  void note_place(SlurmWatched& watched);
  void look_at_folders();

  const SlurmPrograms& programs_;
  const std::chrono::milliseconds poll_;
  mutable std::mutex mutex_;  // guards all below
  std::condition_variable_any changed_;
  std::list<WatchedPtr> watched_;
  std::string obstacle_;
  std::jthread thread_;
};

}  // namespace lacuna
