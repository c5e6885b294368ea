#pragma once

#include <span>

#include "jobs/sweep/answers.h"

namespace lacuna {

/// What the runs of a cell spent before their first iteration. `cell`: its own finished runs;
/// `same_space`: all finished runs of the sweep with its preparation_key(). Cold is
/// what a run took that built all it needed: one of the cell's own, else the cheapest of the others
/// that built all that the cell's runs loaded.
Preparation preparation(std::span<const RunResult* const> cell,
                        std::span<const RunResult* const> same_space);

}  // namespace lacuna
