#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/spec/problems.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// Checks whether the files that jobs name exist. Looks up each name once for all jobs. The scenes
/// roots must outlive it.
class NamedFiles {
 public:
  explicit NamedFiles(const ScenesRoots& scenes) : scenes_(scenes) {}
  /// The missing files that a job names, with pointers into the job.
  std::vector<Problem> missing(const JobSpec& spec);

 private:
  const std::string& look_up(const std::string& name,
                             const std::vector<std::string_view>& extensions);

  const ScenesRoots& scenes_;
  std::map<std::string, std::string> seen_;  // name -> error; empty: none
};

}  // namespace lacuna
