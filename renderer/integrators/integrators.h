#pragma once

#include "renderer/integrators/integrator.h"

namespace lacuna {

// The functions that registry.cpp calls. Each is defined in the source of its name, except make_vcm
// (bdpt.cpp), and make_sppm and make_photon_map (photon_mapping.cpp).
std::unique_ptr<Integrator> make_path(const PathSettings& settings);
std::unique_ptr<Integrator> make_light(const LightSettings& settings);
std::unique_ptr<Integrator> make_bdpt(const BdptSettings& settings);
std::unique_ptr<Integrator> make_vcm(const VcmSettings& settings);
std::unique_ptr<Integrator> make_sppm(const SppmSettings& settings);
std::unique_ptr<Integrator> make_photon_map(const PhotonMapSettings& settings);
std::unique_ptr<Integrator> make_many_lights(const ManyLightsSettings& settings);
std::unique_ptr<Integrator> make_metropolis(const MetropolisSettings& settings);
std::unique_ptr<Integrator> make_inspect(const InspectSettings& settings);

}  // namespace lacuna
