#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/spec/problems.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// Whether the files that jobs name are there. Each name is looked up once, however many jobs have
/// it. The scenes roots outlive it.
class NamedFiles {
 public:
  explicit NamedFiles(const ScenesRoots& scenes) : scenes_(scenes) {}
  /// What a job names and is not there, by pointers into the job; empty: nothing.
  std::vector<Problem> missing(const JobSpec& spec);

 private:
  const std::string& look_up(const std::string& name,
                             const std::vector<std::string_view>& extensions);

  const ScenesRoots& scenes_;
  std::map<std::string, std::string> seen_;  // name -> what is wrong with it; empty: nothing
};

}  // namespace lacuna
