#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/settings/path_settings.h"

namespace lacuna {

std::unique_ptr<Integrator> make_path(const PathSettings& settings);

}  // namespace lacuna
