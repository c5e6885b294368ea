#pragma once

#include <string_view>
#include <variant>

#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// light_guide: skeleton.
struct SkeletonLightGuideSettings {
  static constexpr std::string_view name = "skeleton";
  static constexpr std::string_view doc =
      "light paths are guided towards visible surfaces along the skeleton of the empty space: the "
      "guide `skeleton` with eye and light exchanged";

  double probability = 0.3;
  double strength = 32;
  ImportanceAim aim = ImportanceAim::last;
  int eye_rays = 1 << 16;
  bool operator==(const SkeletonLightGuideSettings&) const = default;
};
template <class V>
void describe(V& v, SkeletonLightGuideSettings& s) {
  v("probability", s.probability,
    {.doc = "probability of sampling a direction from the lobes instead of from the BSDF or the "
            "emission",
     .min = 0,
     .max = most_guided});
  v("strength", s.strength,
    {.doc = "exponent of the power-cosine lobes; 0: uniform over the hemisphere",
     .min = 0,
     .max = 10000});
  v("aim", s.aim,
    {.doc = "the point on the visible part of a shortest path that rays are aimed at"});
  v("eye_rays", s.eye_rays,
    {.doc = "rays from the eye that estimate how much of each node is visible",
     .min = 1,
     .max = 1 << 20});
}

/// How the next direction of a light path is sampled.
using LightGuideSettings = std::variant<BsdfGuideSettings, SkeletonLightGuideSettings>;

template <class V>
void describe_light_guide(V& v, LightGuideSettings& s) {
  v("light_guide", s,
    {.doc = "how the directions of a light path are sampled: from emission and BSDF, or also "
            "towards visible surfaces"});
}

}  // namespace lacuna
