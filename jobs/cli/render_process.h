#pragma once

#include <sys/types.h>

#include "jobs/store/job_folder.h"

namespace lacuna {

/// Runs `lacuna render` on a job's folder as a child process, so that a crash ends nothing else.
class RenderProcess {
 public:
  /// `threads` -1: the job's own number. Throws std::system_error.
  RenderProcess(const JobFolder& folder, int threads);

  /// Sends SIGTERM.
  void terminate() const;
  /// Whether it has ended; the job's state says how. Must not be called again once true.
  bool ended() const;

 private:
  pid_t pid_ = -1;
};

}  // namespace lacuna
