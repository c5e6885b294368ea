#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "jobs/queue/executor.h"
#include "jobs/queue/queue_settings.h"

namespace lacuna {

/// Held between fork and exec of a child, which until then has copies of all open files. Hold it
/// too where such a copy would do harm: a lock on a job's folder would stay.
std::mutex& fork_mutex();

struct Command {
  std::vector<std::string> arguments;    ///< the first is the program's path
  std::vector<std::string> environment;  ///< "NAME=value"
  std::filesystem::path directory;       ///< working directory
  int output_fd = -1;                    ///< where its output goes; -1: nowhere
  ChildLimits limits;
};

/// A running child process, the leader of its own process group. Only the thread that started it
/// may use it: the kernel's notice of a dead parent goes by threads.
class ChildProcess {
 public:
  /// Returns once the program runs; throws std::system_error if it cannot be started.
  explicit ChildProcess(const Command& command);
  pid_t pid() const { return pid_; }  ///< and the number of its group
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess();  ///< kills it if it still runs

  /// Waits until it has ended or `also` is readable (-1: nothing) or the time is up (negative:
  /// forever). True: it has ended.
  bool wait(int also, std::chrono::milliseconds time) const;
  /// To the whole group.
  void signal(int number) const;
  /// Ends what is left of the group and takes the leader's status; only after wait() was true.
  Ending reap();

 private:
  pid_t pid_ = -1;
  FileHandle process_;
};

/// After `command` ended so: why its program does not even say its version, as one that is cut off,
/// or a library of it; empty: it does, or it was no signal that ended it. Throws std::system_error
/// if it cannot be started.
std::string why_it_cannot_begin(Command command, const Ending& end, const StopSignal& stop);

}  // namespace lacuna
