#pragma once

#include <variant>

#include "renderer/settings/bdpt_settings.h"
#include "renderer/settings/inspect_settings.h"
#include "renderer/settings/light_settings.h"
#include "renderer/settings/path_settings.h"

namespace lacuna {

/// Which integrator, and how. The order is the order in menus; the first is the default.
/// renderer/integrators/registry.cpp makes the integrator of each alternative.
using IntegratorSettings = std::variant<PathSettings, LightSettings, BdptSettings, InspectSettings>;

}  // namespace lacuna
