#pragma once

#include "renderer/path/guide.h"
#include "renderer/settings/guide_settings.h"
#include "renderer/settings/light_guide_settings.h"

namespace lacuna {

/// The distribution of the guide with these settings, for eye paths or light paths; null for guide:
/// bsdf.
std::unique_ptr<GuidingDistribution> make_guiding_distribution(const GuideSettings& settings);
std::unique_ptr<GuidingDistribution> make_guiding_distribution(const LightGuideSettings& settings);

/// The guide of eye paths and of light paths with these settings.
Guide make_guide(const GuideSettings& eye, const LightGuideSettings& light = BsdfGuideSettings{});
inline Guide make_light_guide(const LightGuideSettings& light) {
  return make_guide(BsdfGuideSettings{}, light);
}

}  // namespace lacuna
