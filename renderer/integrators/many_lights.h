#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/settings/many_lights_settings.h"

namespace lacuna {

std::unique_ptr<Integrator> make_many_lights(const ManyLightsSettings& settings);

}  // namespace lacuna
