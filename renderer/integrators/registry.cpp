#include "renderer/integrators/integrators.h"

namespace lacuna {

namespace {

struct Make {
  std::unique_ptr<Integrator> operator()(const PathSettings& s) const { return make_path(s); }
  std::unique_ptr<Integrator> operator()(const LightSettings& s) const { return make_light(s); }
  std::unique_ptr<Integrator> operator()(const BdptSettings& s) const { return make_bdpt(s); }
  std::unique_ptr<Integrator> operator()(const VcmSettings& s) const { return make_vcm(s); }
  std::unique_ptr<Integrator> operator()(const SppmSettings& s) const { return make_sppm(s); }
  std::unique_ptr<Integrator> operator()(const PhotonMapSettings& s) const {
    return make_photon_map(s);
  }
  std::unique_ptr<Integrator> operator()(const ManyLightsSettings& s) const {
    return make_many_lights(s);
  }
  std::unique_ptr<Integrator> operator()(const MetropolisSettings& s) const {
    return make_metropolis(s);
  }
  std::unique_ptr<Integrator> operator()(const InspectSettings& s) const { return make_inspect(s); }
};

}  // namespace

std::unique_ptr<Integrator> make_integrator(const IntegratorSettings& settings) {
  return std::visit(Make{}, settings);
}

}  // namespace lacuna
