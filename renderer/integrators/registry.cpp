#include "renderer/integrators/bdpt.h"
#include "renderer/integrators/inspect.h"
#include "renderer/integrators/integrator.h"
#include "renderer/integrators/light.h"
#include "renderer/integrators/many_lights.h"
#include "renderer/integrators/path.h"
#include "renderer/settings/bdpt_settings.h"
#include "renderer/settings/inspect_settings.h"
#include "renderer/settings/light_settings.h"
#include "renderer/settings/many_lights_settings.h"
#include "renderer/settings/path_settings.h"

namespace lacuna {

namespace {

struct Make {
  std::unique_ptr<Integrator> operator()(const PathSettings& s) const { return make_path(s); }
  std::unique_ptr<Integrator> operator()(const LightSettings& s) const { return make_light(s); }
  std::unique_ptr<Integrator> operator()(const BdptSettings& s) const { return make_bdpt(s); }
  std::unique_ptr<Integrator> operator()(const ManyLightsSettings& s) const {
    return make_many_lights(s);
  }
  std::unique_ptr<Integrator> operator()(const InspectSettings& s) const { return make_inspect(s); }
};

}  // namespace

std::unique_ptr<Integrator> make_integrator(const IntegratorSettings& settings) {
  return std::visit(Make{}, settings);
}

}  // namespace lacuna
