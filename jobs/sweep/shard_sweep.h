#pragma once

#include "jobs/spec/job_spec.h"
#include "jobs/spec/sweep_spec.h"

namespace lacuna {

/// The sweep whose runs are the shards of the whole job `job`: run k renders shard k + 1.
SweepSpec shard_sweep(const JobSpec& job);

}  // namespace lacuna
