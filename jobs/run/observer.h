#pragma once

#include <string>

#include "jobs/store/job_folder.h"

namespace lacuna {

/// Whoever wants to see a job going on: a terminal, a log.
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
