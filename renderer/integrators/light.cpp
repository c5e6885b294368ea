#include "renderer/integrators/integrators.h"

#include "renderer/guides/make_guide.h"
#include "renderer/integrators/guided_integrator.h"
#include "renderer/path/light_pass.h"
#include "renderer/settings/light_settings.h"

namespace lacuna {

namespace {

/// Light tracing (Noel 2015, 4.2.5): the strategies t = 1 alone.
class Light final : public GuidedIntegrator {
 public:
  Light(const LightSettings& settings, Guide guide)
      : GuidedIntegrator(std::move(guide)), settings_(settings) {}

  Counters iterate(const IterationContext& context, Image& image) override {
    const std::int64_t paths = light_paths(settings_.light_paths, image);
    const LightPathSetting setting{context.scene,
                                   context.camera,
                                   settings_.max_depth,
                                   settings_.roulette_depth,
                                   {.hit = 0, .splat = static_cast<double>(paths)},
                                   false,
                                   EmitterChoice::power,
                                   context.light.automaton(),
                                   context.observer,
                                   context.iteration};
    return light_pass(
        {context, setting, paths, image}, this->guide_,
        [](std::size_t, const LightBatch&, std::size_t) {}, [](const Splat&) {});
  }

 private:
  LightSettings settings_;
};

}  // namespace

std::unique_ptr<Integrator> make_light(const LightSettings& settings) {
  return std::make_unique<Light>(settings, make_light_guide(settings.light_guide));
}

}  // namespace lacuna
