#pragma once

#include <string>

#include "jobs/store/job_folder.h"

namespace lacuna {

/// Receives the progress of a job, for example to show it on a terminal.
class Observer {
 public:
  virtual ~Observer() = default;
  /// "loading", "reference", "rendering", "writing".
  virtual void phase(const std::string& name) = 0;
  virtual void progress(const Progress& p) = 0;
  /// A row was added to the curve or a checkpoint was written.
  virtual void milestone(const std::string& line) = 0;
  virtual void warning(const std::string& line) = 0;
};

}  // namespace lacuna
