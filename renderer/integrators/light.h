#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/settings/light_settings.h"

namespace lacuna {

std::unique_ptr<Integrator> make_light(const LightSettings& settings);

}  // namespace lacuna
