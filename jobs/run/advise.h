#pragma once

#include "jobs/run/choice.h"
#include "jobs/run/run_job.h"

namespace lacuna {

/// The job with the integrator `auto`; keeps the path lengths of another integrator.
JobSpec with_auto_integrator(JobSpec spec);

/// Chooses the method of the job in `folder`, whose integrator is `auto`, as run_job() does, which
/// can continue from there. Throws the exceptions of prepare() and Choosing, and Stopped.
Choice advise(const JobFolder& folder, const RunContext& context);

}  // namespace lacuna
