#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "base/json/number_or_null.h"
#include "jobs/run/machine_watch.h"
#include "jobs/run/reference.h"

namespace lacuna {

// Parts of report.json that jobs of all integrators have.

/// The reference that errors were measured against, and whether its noise dominates them.
OrderedJson reference_json(const Reference& reference, bool at_floor);

/// The machine, its other load during rendering, if it was measured, and the threads of the job.
OrderedJson machine_json(int threads, const std::optional<Disturbance>& disturbance);

}  // namespace lacuna
