#pragma once

#include <sys/types.h>

#include <atomic>
#include <functional>
#include <string>
#include <system_error>

#include "base/storage/file_handle.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// How a renderer ended.
struct Ending {
  /// not_started: the program or the machine cannot start a renderer; not an error of the job.
  /// out_of_memory: it reported exit_memory, or the kernel killed it for lack of memory. lost: its
  /// machine or its time was withdrawn, or its end is unknown. refused: the executor will not run
  /// this job, or its folder is damaged. left: it continues, and the next run() of the job finds
  /// it.
  enum class Kind { exited, killed, not_started, out_of_memory, lost, refused, left };
  Kind kind = Kind::exited;
  /// exited, out_of_memory: exit code (128 + SIGKILL if killed); killed: signal; not_started:
  /// errno; lost, refused: exit code, or 0 if there is none
  int code = 0;
  std::string reason;      ///< "renderer ended by signal 9 (Killed)"
  double cpu_seconds = 0;  ///< of a child and its descendants that ended (ChildProcess)
};

/// Whether the program never began: it is missing, cannot be executed, or lacks a library (the exit
/// codes of shells and the dynamic loader).
inline bool never_began(const Ending& end) {
  return end.kind == Ending::Kind::not_started ||
         (end.kind == Ending::Kind::exited && (end.code == 126 || end.code == 127));
}

/// The ending if no renderer was started because a file of the job's folder could not be opened or
/// written. A missing folder is not an error of the job; its next reader detects it.
Ending folder_unusable(const JobFolder& folder, const std::system_error& error);

/// A request to stop, sent by any thread and awaited by one.
class StopSignal {
 public:
  StopSignal();  ///< throws std::system_error
  void request() const;
  /// The queue's process ends; the renderer continues.
  void leave() const;
  bool is_requested() const { return requested_.load(); }
  bool leaves() const { return leaves_.load(); }
  int fd() const { return event_.get(); }  ///< readable once either was called

 private:
  FileHandle event_;
  mutable std::atomic<bool> requested_{false}, leaves_{false};
};

/// The interface that runs renderers, for example in child processes or on a cluster.
class Executor {
 public:
  virtual ~Executor() = default;
  /// Callbacks while a job runs. Each may be empty, and must not throw.
  struct Notices {
    /// Called once the renderer runs, with its process, the leader of its own group; 0: it runs or
    /// waits on another machine.
    std::function<void(pid_t)> started;
    /// Called with the place where it runs or waits, for people.
    std::function<void(const std::string&)> place;
  };
  /// A job that is to be rendered.
  struct Task {
    JobFolder folder;
    int priority = 0;
    int crashes = 0;  ///< number of its renderers that crashed
  };
  /// Renders one job; returns when its renderer has ended. `stop` makes the renderer write a
  /// checkpoint and end. Called from several threads.
  virtual Ending run(const Task& task, const StopSignal& stop, const Notices& notices) = 0;

  /// Whether another system runs the renderers, on other machines: they outlive the queue, and each
  /// exclusive job gets a machine of its own.
  virtual bool is_remote() const { return false; }
  /// Whether a renderer of the job may run or wait, also one of an earlier queue: run() continues
  /// with it, and until then the folder belongs to it.
  virtual bool holds(const JobFolder&) const { return false; }
  /// Makes holds() false for a job whose renderer has ended. Throws std::system_error.
  virtual void forget(const JobFolder&) {}
  /// Called when the priority of a running job has changed.
  virtual void set_priority(const JobFolder&, int) {}
  /// The transient obstacle to running any job; empty: none.
  virtual std::string obstacle() const { return {}; }
};

}  // namespace lacuna
