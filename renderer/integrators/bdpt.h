#pragma once

#include "renderer/integrators/integrator.h"

namespace lacuna {

std::unique_ptr<Integrator> make_bdpt(const BdptSettings& settings);

}  // namespace lacuna
