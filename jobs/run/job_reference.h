#pragma once

#include <optional>

#include "jobs/run/prepare.h"
#include "jobs/run/reference.h"
#include "jobs/run/run_job.h"

namespace lacuna {

/// The reference of a job that names one: read, or for "auto" rendered as a separate job by the
/// first process that needs it. Only `camera_name` and `content` of `prepared` are used. None if
/// interrupted. Throws the exceptions of find_reference() and run_job().
std::optional<Reference> job_reference(const JobFolder& folder, const JobSpec& spec,
                                       const Prepared& prepared, const RunContext& context);

}  // namespace lacuna
