#pragma once

#include <string_view>

#include "renderer/settings/light_guide_settings.h"
#include "renderer/settings/path_lengths.h"

namespace lacuna {

/// integrator: light.
struct LightSettings : PathLengths {
  static constexpr std::string_view name = "light";
  static constexpr std::string_view doc =
      "light tracing: paths from the lights, connected to the eye (Noel 2015, 4.2.5); mirrors and "
      "clear glass are black";

  /// No paths start at the eye, so surfaces that few light paths hit are noisy.
  static constexpr bool from_lights_only = true;
  static constexpr bool shares_light_paths = true;

  int light_paths = 0;
  LightGuideSettings light_guide = BsdfGuideSettings{};

  bool operator==(const LightSettings&) const = default;
};

template <class V>
void describe(V& v, LightSettings& s) {
  describe_lengths(v, s);
  v("light_paths", s.light_paths,
    {.doc = "light paths per iteration; 0: one per pixel", .min = 0, .max = 1 << 20});
  describe_light_guide(v, s.light_guide);
}

}  // namespace lacuna
