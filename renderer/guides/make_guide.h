#pragma once

#include <memory>
#include <utility>
#include <variant>

#include "renderer/guides/mixed_guide.h"
#include "renderer/settings/guide_settings.h"
#include "renderer/settings/light_guide_settings.h"

namespace lacuna {

/// The distribution of the guide with these settings, of eye paths or of light paths; null for
/// guide: bsdf.
std::unique_ptr<GuidingDistribution> make_guiding_distribution(const GuideSettings& settings);
std::unique_ptr<GuidingDistribution> make_guiding_distribution(const LightGuideSettings& settings);

/// Returns `make(guide)` with the guide of these settings: a BsdfGuide or a MixedGuide, so that
/// integrators are compiled for these two only.
template <class Make>
auto with_guides(const GuideSettings& eye, const LightGuideSettings& light, Make&& make) {
  auto of_eye = make_guiding_distribution(eye);
  auto of_light = make_guiding_distribution(light);
  if (of_eye || of_light) return make(MixedGuide(std::move(of_eye), std::move(of_light)));
  return make(BsdfGuide{});
}
/// The same where only one kind of paths can be guided.
template <class Make>
auto with_guide(const GuideSettings& eye, Make&& make) {
  return with_guides(eye, BsdfGuideSettings{}, std::forward<Make>(make));
}
template <class Make>
auto with_light_guide(const LightGuideSettings& light, Make&& make) {
  return with_guides(BsdfGuideSettings{}, light, std::forward<Make>(make));
}

}  // namespace lacuna
