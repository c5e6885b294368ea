#pragma once

#include <sys/types.h>

#include "jobs/store/job_folder.h"

namespace lacuna {

/// A `lacuna render` of its own on a job's folder: what ends it ends nothing else.
class RenderProcess {
 public:
  /// `threads` -1: the job's own number. Throws std::system_error.
  RenderProcess(const JobFolder& folder, int threads);

  /// Asks it to stop soon.
  void terminate() const;
  /// Whether it has ended; how it did stands in the job's state. Once true, not to be asked again.
  bool ended() const;

 private:
  pid_t pid_ = -1;
};

}  // namespace lacuna
