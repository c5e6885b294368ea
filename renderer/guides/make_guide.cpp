#include "renderer/guides/make_guide.h"

#include "renderer/guides/registry.h"

namespace lacuna {

std::unique_ptr<GuidingDistribution> make_guiding_distribution(const GuideSettings& settings) {
  return GuideRegistry::visit(settings,
                              []<class G>(const auto& s) -> std::unique_ptr<GuidingDistribution> {
                                if constexpr (std::derived_from<G, GuidingDistribution>) {
                                  return std::make_unique<G>(s);
                                } else {
                                  static_assert(std::is_same_v<G, NoDistribution>);
                                  return nullptr;
                                }
                              });
}

std::unique_ptr<GuidingDistribution> make_guiding_distribution(const LightGuideSettings& settings) {
  const auto* s = std::get_if<SkeletonLightGuideSettings>(&settings);
  return s == nullptr ? nullptr : std::make_unique<SkeletonDirections>(*s);
}

Guide make_guide(const GuideSettings& eye, const LightGuideSettings& light) {
  const GuidedRoulette roulette = std::visit(
      [](const auto& s) {
        if constexpr (requires { s.roulette; }) return s.roulette;
        return GuidedRoulette::window;
      },
      eye);
  return Guide(make_guiding_distribution(eye), make_guiding_distribution(light), roulette);
}

}  // namespace lacuna
