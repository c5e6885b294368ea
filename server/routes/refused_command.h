#pragma once

#include <variant>
#include <vector>

#include "jobs/spec/job_spec.h"
#include "jobs/spec/problems.h"

namespace lacuna {

/// The problem of a job that would run a command of its client's choice on this machine, if it is
/// one.
inline std::vector<Problem> refused_command(const JobSpec& job) {
  const auto* foreign = std::get_if<ForeignSettings>(&job.integrator);
  if (foreign == nullptr || foreign->command.empty()) return {};
  return {{"/integrator/command",
           "found a command, which the service does not run; allowed: \"pictures\", or `lacuna "
           "render` and `lacuna sweep`"}};
}

}  // namespace lacuna
