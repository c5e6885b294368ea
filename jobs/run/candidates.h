#pragma once

#include <string>
#include <vector>

#include "jobs/spec/auto_settings.h"

namespace lacuna {

/// The methods that a job of `auto` chooses from, with its path lengths: those that it lists, or by
/// default one of each type that is best for some scene, the most robust first.
std::vector<CandidateSettings> candidates(const AutoSettings& settings);

/// The integrator with its settings that are not defaults: "path, learned_skeleton, reuse 64".
std::string candidate_name(const CandidateSettings& settings);

}  // namespace lacuna
