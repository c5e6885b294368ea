#include "renderer/integrators/inspect.h"
#include "renderer/integrators/integrator.h"
#include "renderer/integrators/path.h"

namespace lacuna {

namespace {

struct Make {
  std::unique_ptr<Integrator> operator()(const PathSettings& s) const { return make_path(s); }
  std::unique_ptr<Integrator> operator()(const InspectSettings& s) const { return make_inspect(s); }
};

}  // namespace

std::unique_ptr<Integrator> make_integrator(const IntegratorSettings& settings) {
  return std::visit(Make{}, settings);
}

}  // namespace lacuna
