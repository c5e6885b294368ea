#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "jobs/store/job_folder.h"
#include "server/executor.h"
#include "server/settings.h"
#include "server/verdict.h"

namespace lacuna {

/// The jobs that wait and those that are rendered, first come, first served. The folders are the
/// truth; this is what can be rebuilt from them. While a renderer runs, its job's state.json
/// belongs to it; before and after, to the queue.
class Queue {
 public:
  Queue(DataRoot data, Executor& executor, QueueSettings settings);
  ~Queue() { stop(); }
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;

  /// Puts every unfinished job below the data root in the line again, and begins.
  void start();
  /// Asks all renderers to stop and waits for them; their jobs go on after the next start().
  void stop();

  /// A new job, whose folder is complete on disk.
  void add(const JobFolder& folder);

  enum class Cancel { cancelled, cancelling, over };
  /// Stops a job for good. `cancelling`: its renderer was asked to stop and has not ended yet.
  /// `over`: it had ended before, or it is not in this queue.
  Cancel cancel(const JobFolder& folder);

  /// The job waits or is rendered, or its renderer's end is being noted.
  bool holds(const JobFolder& folder) const;

  /// Where a job stands; final if it is terminal and holds() was false before. Throws
  /// std::runtime_error if its folder does not say.
  JobState state(const JobFolder& folder) const;

 private:
  /// A job that waits or is rendered.
  struct Work {
    StopSignal stop;
    bool cancel = false;
    int crashes = 0;
  };

  JobFolder folder(const std::string& id) const { return JobFolder(data_.jobs() / id); }
  void rebuild(const JobFolder& folder);
  void run();
  std::optional<std::string> take();
  void attend(const std::string& id, Work& work);
  bool wait_until_free(const JobFolder& folder);
  void settle(const std::string& id, Work& work, Attempt attempt);
  bool withdraw(const JobFolder& folder);
  void save(const JobFolder& folder, const JobState& state);

  const DataRoot data_;
  Executor& executor_;
  const QueueSettings settings_;

  mutable std::mutex mutex_;  // guards all below; nothing is read, written or waited for under it
  std::condition_variable changed_;
  std::deque<std::string> waiting_;
  std::map<std::string, std::shared_ptr<Work>> work_;
  std::map<std::string, JobState> unsaved_;  // states that could not be written (disk full)
  bool stopping_ = false;
  std::vector<std::thread> runners_;
};

}  // namespace lacuna
