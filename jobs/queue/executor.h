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
  /// not_started: there is no program that starts, or the machine cannot start one; no fault of the
  /// job. out_of_memory: it reported exit_memory, or the kernel killed it for lack of memory.
  /// lost: its machine or its time was taken from it, or nobody knows. refused: who runs renderers
  /// will not run this one, or its folder is damaged. left: it goes on, and whoever runs the job
  /// next finds it.
  enum class Kind { exited, killed, not_started, out_of_memory, lost, refused, left };
  Kind kind = Kind::exited;
  /// exit code, out_of_memory too (128 + SIGKILL if killed); signal; errno; lost and refused: the
  /// exit code if there was one, else 0
  int code = 0;
  std::string reason;  ///< "renderer ended by signal 9 (Killed)"
};

/// A program that ended so never began: it is not there, cannot be executed, or lacks a library
/// (what shells and the dynamic loader exit with).
inline bool never_began(const Ending& end) {
  return end.kind == Ending::Kind::not_started ||
         (end.kind == Ending::Kind::exited && (end.code == 126 || end.code == 127));
}

/// No renderer is started because a file of the job's folder could not be opened or written. One
/// that is gone as a whole is no fault of the job: whoever looks for it next finds that out.
Ending folder_unusable(const JobFolder& folder, const std::system_error& error);

/// A request to stop, sent by any thread and awaited by one.
class StopSignal {
 public:
  StopSignal();  ///< throws std::system_error
  void request() const;
  /// The process of the queue ends; the renderer does not.
  void leave() const;
  bool is_requested() const { return requested_.load(); }
  bool leaves() const { return leaves_.load(); }
  int fd() const { return event_.get(); }  ///< readable from the first of both on

 private:
  FileHandle event_;
  mutable std::atomic<bool> requested_{false}, leaves_{false};
};

/// The interface that runs renderers, for example in child processes or on a cluster.
class Executor {
 public:
  virtual ~Executor() = default;
  /// What is told of a job while it is run. Each may be empty, and must not throw.
  struct Notices {
    /// The process that renders, the leader of its own group, once it runs; 0: it is not of this
    /// machine, or it waits elsewhere.
    std::function<void(pid_t)> started;
    /// Where it runs or waits, for a person.
    std::function<void(const std::string&)> place;
  };
  /// A job that is to be rendered.
  struct Task {
    JobFolder folder;
    int priority = 0;
    int crashes = 0;  ///< renderers of it that crashed
  };
  /// Renders one job; returns when its renderer has ended. `stop` asks that renderer to write a
  /// checkpoint and end. Called from several threads.
  virtual Ending run(const Task& task, const StopSignal& stop, const Notices& notices) = 0;

  /// Its renderers are run by somebody else, on machines of theirs: they outlive the queue, and
  /// each job that wants a machine for itself gets one.
  virtual bool is_remote() const { return false; }
  /// A renderer of the job may run or wait, from an earlier queue, too: run() goes on with that
  /// one, and until then the folder is not ours.
  virtual bool holds(const JobFolder&) const { return false; }
  /// Gives up what holds() says of a job whose renderer has ended. Throws std::system_error.
  virtual void forget(const JobFolder&) {}
  /// The priority of a job that it runs has changed.
  virtual void set_priority(const JobFolder&, int) {}
  /// What keeps it from running anything, and may pass; empty: nothing.
  virtual std::string obstacle() const { return {}; }
};

}  // namespace lacuna
