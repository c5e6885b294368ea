#pragma once

#include <string>
#include <vector>

#include "renderer/settings/auto_settings.h"
#include "renderer/settings/integrator_settings.h"

namespace lacuna {

/// Integrators that may race, with the path lengths of `settings`: those that it lists, or by
/// default one of each kind that wins somewhere.
std::vector<IntegratorSettings> candidates(const AutoSettings& settings);

/// The integrator and its strategies other than the default, as "bdpt, skeleton".
std::string candidate_name(const IntegratorSettings& settings);

}  // namespace lacuna
