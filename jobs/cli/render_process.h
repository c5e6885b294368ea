#pragma once

#include <sys/types.h>

#include <optional>

#include "jobs/store/job_folder.h"

namespace lacuna {

/// Runs `lacuna render` on a job's folder as a child process, so that a crash ends nothing else.
class RenderProcess {
 public:
  /// `threads` -1: the job's own number. Throws std::system_error.
  RenderProcess(const JobFolder& folder, int threads);

  /// Sends SIGTERM.
  void terminate() const;
  /// Its exit code, 128 and more for a signal, once it has ended; the job's state says more. Must
  /// not be called again after that.
  std::optional<int> ended() const;

 private:
  pid_t pid_ = -1;
};

}  // namespace lacuna
