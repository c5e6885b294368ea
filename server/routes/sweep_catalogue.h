#pragma once

#include "base/json/json_text.h"
#include "jobs/queue/store.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

/// The sweep with this id; throws HttpError 404.
SweepEntry find_sweep(const Store& store, const std::string& id);

/// As an element of the API's list of sweeps: {id, label, state, created, finished, error,
/// run_count, counts, share}. `share`: of its runs that is over, [0, 1]; running ones count in
/// part.
OrderedJson to_json(const SweepEntry& sweep, const Store& store);

/// The plan of a sweep file: {spec, cell_count, run_count, cells: [{text, settings, baseline}]}.
/// Cells, baselines and replicates count from 1, as in the table.
OrderedJson plan_json(const SweepSpec& spec, const SweepPlan& plan);

/// One sweep: its entry, its plan, and runs: [{run, job, cell, replicate, state}] in the order of
/// rendering. A run that is not yet a job has the job null and is `queued`; if it never will be, or
/// was removed, its state is null, too.
OrderedJson sweep_detail(const SweepEntry& sweep, const SweepFolder& folder, const Store& store);

}  // namespace lacuna
