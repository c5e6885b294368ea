#pragma once

#include "jobs/run/run_job.h"
#include "jobs/spec/job_spec.h"
#include "renderer/race/record.h"

namespace lacuna {

/// What the integrator `auto` finds out about a job's picture before it renders it: the race of its
/// candidates. Another integrator of the job is not raced: `auto` takes its path lengths. Artefacts
/// of the analysis go to the cache. Throws what prepare() and analyse() throw.
RaceRecord advise(JobSpec spec, const RunContext& context);

}  // namespace lacuna
