#pragma once

#include <sys/types.h>

#include <functional>
#include <string>

#include "analysis/storage/file_handle.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// How a renderer ended.
struct Ending {
  /// out_of_memory: it reported exit_memory, or the kernel killed it for lack of memory.
  enum class Kind { exited, killed, not_started, out_of_memory };
  Kind kind = Kind::exited;
  int code = 0;        ///< exit code, out_of_memory too (128 + SIGKILL if killed); signal; errno
  std::string reason;  ///< "renderer ended by signal 9 (Killed)"
};

/// A request to stop, sent by any thread and awaited by one.
class StopSignal {
 public:
  StopSignal();  ///< throws std::system_error
  void request() const;
  int fd() const { return event_.get(); }  ///< readable from the request on

 private:
  FileHandle event_;
};

/// The interface that runs renderers, for example in child processes or on a cluster.
class Executor {
 public:
  virtual ~Executor() = default;
  /// Called with the process that renders, the leader of its own group, once it runs.
  using Started = std::function<void(pid_t)>;
  /// Renders one job; returns when its renderer has ended. `stop` asks that renderer to write a
  /// checkpoint and end. `started` may be empty, and must not throw. Called from several threads.
  virtual Ending run(const JobFolder& folder, const StopSignal& stop, const Started& started) = 0;
};

}  // namespace lacuna
