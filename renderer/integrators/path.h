#pragma once

#include "renderer/integrators/integrator.h"

namespace lacuna {

std::unique_ptr<Integrator> make_path(const PathSettings& settings);

}  // namespace lacuna
