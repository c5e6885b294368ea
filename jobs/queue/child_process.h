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

/// Held between fork and exec of a child, which has copies of all open files until then. Also hold
/// it where such a copy does harm: it would keep a lock on a job's folder.
std::mutex& fork_mutex();

struct Command {
  std::vector<std::string> arguments;    ///< the first is the program's path
  std::vector<std::string> environment;  ///< "NAME=value"
  std::filesystem::path directory;       ///< working directory
  int output_fd = -1;                    ///< where its output goes; -1: discarded
  int error_fd = -1;                     ///< where its standard error goes; -1: with its output
  ChildLimits limits;
};

/// A running child process, the leader of its own process group. Only the thread that started it
/// may use it: the kernel signals the death of the parent thread, not process.
class ChildProcess {
 public:
  /// Returns once the program runs; throws std::system_error if it cannot be started.
  explicit ChildProcess(const Command& command);
  pid_t pid() const { return pid_; }  ///< also the number of its group
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess();  ///< kills it if it still runs

  /// Waits until it has ended, `also` is readable (-1: none) or `time` has passed (negative: no
  /// limit). Returns whether it has ended.
  bool wait(int also, std::chrono::milliseconds time) const;
  /// Sends a signal to the whole group.
  void signal(int number) const;
  /// Kills the rest of the group and returns how the leader ended; only after wait() returned true.
  Ending reap();

 private:
  pid_t pid_ = -1;
  FileHandle process_;
};

/// How a command ended whose time was limited.
struct BoundedRun {
  Ending end;
  bool in_time = true;         ///< false: it was killed, at the end of its time or for a stop
  std::string output, errors;  ///< what it wrote, to its standard output and error
};

/// Runs a command to its end, for at most `time`, or until the descriptor `stop` is readable (-1:
/// none). Its output is kept in memory, so that the limit of its files (ChildLimits::file_bytes)
/// limits it, too; the first 64 MiB are returned. Throws std::system_error if it cannot be started.
BoundedRun run_bounded(Command command, int stop, std::chrono::milliseconds time);

/// The environment variables of this process: "NAME=value".
std::vector<std::string> own_environment();

/// If `command` ended by a signal, runs it with --version: why that fails, for example because the
/// program or a library is truncated; empty: it succeeds, or no signal ended `command`. Throws
/// std::system_error if it cannot be started.
std::string why_it_cannot_begin(Command command, const Ending& end, const StopSignal& stop);

}  // namespace lacuna
