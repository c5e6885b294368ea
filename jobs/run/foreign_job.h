#pragma once

#include "jobs/run/run_job.h"
#include "jobs/run/running.h"

namespace lacuna {

/// Runs a job of the integrator `foreign`: reads the pictures of the job's seed, or runs the
/// command for each of its render times, and writes the results of the last picture and a curve
/// with one row for each. A picture that a command has rendered is kept in the job's folder with
/// its time, and is not rendered again. A seed without pictures is done without a curve. Throws
/// SceneError (a missing or unusable picture, a command that fails), the exceptions of prepare()
/// and job_reference(), std::system_error, Stopped.
Outcome run_foreign(const JobFolder& folder, const JobSpec& spec, const RunContext& context,
                    Running& running);

}  // namespace lacuna
