#include "renderer/guides/make_guide.h"

#include "renderer/guides/registry.h"
#include "renderer/guides/skeleton_to_eye.h"

namespace lacuna {

std::unique_ptr<GuidingDistribution> make_guiding_distribution(const GuideSettings& settings) {
  return GuideRegistry::visit(settings,
                              []<class G>(const auto& s) -> std::unique_ptr<GuidingDistribution> {
                                if constexpr (std::derived_from<G, GuidingDistribution>) {
                                  return std::make_unique<G>(s);
                                } else {
                                  static_assert(std::is_same_v<G, BsdfGuide>);
                                  return nullptr;
                                }
                              });
}

std::unique_ptr<GuidingDistribution> make_guiding_distribution(const LightGuideSettings& settings) {
  const auto* s = std::get_if<SkeletonLightGuideSettings>(&settings);
  return s == nullptr ? nullptr : std::make_unique<SkeletonToEye>(*s);
}

}  // namespace lacuna
