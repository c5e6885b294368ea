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

/// How the job of a submission ended, according to its folder or else to Slurm. `code`: from
/// read_submission_exit(). `last`: Slurm's latest record, if any.
Ending slurm_ending(std::optional<int> code, const std::optional<SlurmJob>& last, bool known_now);

/// One submission that a runner waits for. The watch's lock guards its members.
struct SlurmWatched {
  using Clock = std::chrono::steady_clock;
  JobFolder folder;
  Submission submission;
  std::function<void(const std::string&)> place;
  FileHandle event;                        ///< readable when there is news for the runner
  Clock::time_point since = Clock::now();  ///< earlier listings do not concern it
  std::optional<SlurmJob> last = {};
  std::optional<Clock::time_point> gone_since = {};  ///< Slurm does not list it
  int gone = 0;                                      ///< number of listings without it
  bool asked_accounts = false;
  bool unknown = false;               ///< Slurm never listed it
  std::optional<Ending> ending = {};  ///< set when it is over
  std::optional<int> nice = {};       ///< to be set by the runner
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

  /// A submission is watched during the life of this object.
  class Guest {
   public:
    /// Throws std::system_error if no descriptor is left.
    Guest(SlurmWatch& watch, const JobFolder& folder, const Submission& submission,
          std::function<void(const std::string&)> place);
    ~Guest();
    Guest(const Guest&) = delete;
    Guest& operator=(const Guest&) = delete;
    /// Resets the event and returns the view.
    View look() const;
    /// Readable when the view has changed.
    int event() const { return watched_->event.get(); }

   private:
    SlurmWatch& watch_;
    std::shared_ptr<SlurmWatched> watched_;
  };

  /// Makes the runner of this job, if any, set it.
  void set_nice(const JobFolder& folder, int nice);
  /// Why the last call of squeue failed; empty: it succeeded.
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
