#pragma once

#include <string>

#include "analysis/storage/file_handle.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// How a renderer ended.
struct Ending {
  enum class Kind { exited, killed, not_started };
  Kind kind = Kind::exited;
  int code = 0;        ///< exit code; signal; errno
  std::string reason;  ///< "renderer ended by signal 9 (Killed)"
};

/// A request to stop, made by any thread and waited for by one.
class StopSignal {
 public:
  StopSignal();  ///< throws std::system_error
  void request() const;
  int fd() const { return event_.get(); }  ///< readable from the request on

 private:
  FileHandle event_;
};

/// Runs renderers: here in child processes; elsewhere perhaps on a cluster.
class Executor {
 public:
  virtual ~Executor() = default;
  /// Renders one job; returns when its renderer has ended. `stop` asks that renderer to write a
  /// checkpoint and end. Called from several threads.
  virtual Ending run(const JobFolder& folder, const StopSignal& stop) = 0;
};

}  // namespace lacuna
