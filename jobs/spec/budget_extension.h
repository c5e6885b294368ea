#pragma once

#include <vector>

#include "jobs/spec/job_spec.h"
#include "jobs/spec/problems.h"

namespace lacuna {

/// The reasons why `larger` is not an extension of `old`. A limit that both have may not shrink; an
/// error target may not grow or change its metric; at least one limit must grow (an error target:
/// shrink) or be removed; at least one must remain. Pointers are into a job ("/budget/seconds").
std::vector<Problem> extension_problems(const Budget& old, const Budget& larger);

}  // namespace lacuna
