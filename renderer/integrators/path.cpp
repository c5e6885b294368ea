#include "renderer/integrators/integrators.h"

#include "renderer/guides/make_guide.h"
#include "renderer/integrators/path_tracer.h"
#include "renderer/settings/auto_settings.h"
#include "renderer/settings/path_settings.h"

namespace lacuna {

namespace {

/// Adaptive sampling is a race with one entrant.
AutoSettings adaptive(PathSettings settings) {
  AutoSettings race;
  static_cast<PathLengths&>(race) = settings;
  settings.sampling = Sampling::uniform;
  race.candidates = {settings};
  race.clock = RaceClock::rays;
  return race;
}

}  // namespace

std::unique_ptr<Integrator> make_path(const PathSettings& settings) {
  if (settings.sampling == Sampling::adaptive) return make_auto(adaptive(settings));
  return with_guide(settings.guide, [&]<class Guide>(Guide guide) -> std::unique_ptr<Integrator> {
    return std::make_unique<PathTracer<Guide>>(settings, std::move(guide));
  });
}

}  // namespace lacuna
