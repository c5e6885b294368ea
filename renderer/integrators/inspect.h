#pragma once

#include "renderer/integrators/integrator.h"

namespace lacuna {

std::unique_ptr<Integrator> make_inspect(const InspectSettings& settings);

}  // namespace lacuna
