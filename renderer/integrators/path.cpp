#include "renderer/guides/make_guide.h"
#include "renderer/integrators/integrators.h"
#include "renderer/integrators/path_tracer.h"

namespace lacuna {

std::unique_ptr<Integrator> make_path(const PathSettings& settings) {
  return std::make_unique<PathTracer>(settings, make_guide(settings.guide));
}

}  // namespace lacuna
