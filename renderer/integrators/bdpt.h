#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/settings/bdpt_settings.h"

namespace lacuna {

std::unique_ptr<Integrator> make_bdpt(const BdptSettings& settings);

}  // namespace lacuna
