#pragma once

#include "analysis/artefacts/store.h"
#include "jobs/spec/job_spec.h"
#include "renderer/race/verdict.h"

namespace lacuna {

/// Verdicts of races in the cache of artefacts: one for each picture (scene, camera, integrator and
/// whatever else changes it, but for the seed), candidates of the race and power of four of the
/// budget. `content`: hashes of the files the picture depends on. `store` must outlive the result.
VerdictMemory cached_verdicts(ArtefactStore& store, const JobSpec& spec, const std::string& content,
                              double budget_seconds);

}  // namespace lacuna
