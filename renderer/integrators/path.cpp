#include "renderer/integrators/integrators.h"

#include "renderer/guides/make_guide.h"
#include "renderer/integrators/path_tracer.h"
#include "renderer/settings/path_settings.h"

namespace lacuna {

std::unique_ptr<Integrator> make_path(const PathSettings& settings) {
  return with_guide(settings.guide, [&]<class Guide>(Guide guide) -> std::unique_ptr<Integrator> {
    return std::make_unique<PathTracer<Guide>>(settings, std::move(guide));
  });
}

}  // namespace lacuna
