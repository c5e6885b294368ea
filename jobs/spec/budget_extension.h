#pragma once

#include <vector>

#include "jobs/spec/job_spec.h"
#include "jobs/spec/problems.h"

namespace lacuna {

/// What keeps `larger` from being more of the same than `old`: each limit that both have may be no
/// smaller, an error target no larger and of the same metric, and at least one limit must grow (an
/// error target: fall) or go; one must be left. Pointers are those of a job ("/budget/seconds").
std::vector<Problem> extension_problems(const Budget& old, const Budget& larger);

}  // namespace lacuna
