#pragma once

#include "jobs/run/choice.h"
#include "jobs/run/run_job.h"

namespace lacuna {

/// A job with the integrator `auto`, of the same path lengths where it has another.
JobSpec with_auto_integrator(JobSpec spec);

/// Chooses the method of the job of `folder`, whose integrator is `auto`, as run_job() does, and
/// stops there: run_job() goes on from it. Throws what prepare() and Choosing throw, and Stopped.
Choice advise(const JobFolder& folder, const RunContext& context);

}  // namespace lacuna
