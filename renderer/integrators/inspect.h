#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/settings/inspect_settings.h"

namespace lacuna {

std::unique_ptr<Integrator> make_inspect(const InspectSettings& settings);

}  // namespace lacuna
