#pragma once

#include <string>
#include <vector>

#include "jobs/run/observer.h"

namespace lacuna {

/// Keeps what it is told.
class SilentObserver final : public Observer {
 public:
  void phase(const std::string& name) override { phases.push_back(name); }
  void progress(const Progress&) override {}
  void milestone(const std::string& line) override { milestones.push_back(line); }
  void warning(const std::string& line) override { warnings.push_back(line); }
  std::vector<std::string> phases, warnings, milestones;
};

}  // namespace lacuna
