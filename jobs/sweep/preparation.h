#pragma once

#include <span>

#include "jobs/sweep/answers.h"

namespace lacuna {

/// The time that the runs of a cell took before their first iteration. `cell`: its own finished
/// runs; `same_space`: all finished runs of the sweep with its preparation_key(). The cold time is
/// that of a run that built all it needed: one of the cell's own runs, else the fastest of the
/// others that built all artefacts that the cell's runs loaded.
Preparation preparation(std::span<const RunResult* const> cell,
                        std::span<const RunResult* const> same_space);

}  // namespace lacuna
