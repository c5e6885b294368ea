#pragma once

#include "base/json/json_text.h"
#include "jobs/queue/store.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

/// A sweep that is there; throws HttpError 404.
SweepEntry find_sweep(const Store& store, const std::string& id);

/// As an element of the API's list of sweeps: {id, label, state, created, finished, error,
/// run_count, counts, share}. `share` of its runs is over, [0, 1]; one that goes on counts in part.
OrderedJson to_json(const SweepEntry& sweep, const Store& store);

/// What a sweep file comes to: {spec, cell_count, run_count, cells: [{text, settings, baseline}]}.
/// Cells, baselines and replicates count from 1, as in the table.
OrderedJson plan_json(const SweepSpec& spec, const SweepPlan& plan);

/// One sweep: its entry, its plan, and runs: [{run, job, cell, replicate, state}] in the order in
/// which they are done. A run that is no job yet has the job null and is `queued`; of one that
/// never will be, or has been removed, the state is null, too.
OrderedJson sweep_detail(const SweepEntry& sweep, const SweepFolder& folder, const Store& store);

}  // namespace lacuna
