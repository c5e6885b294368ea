#pragma once

#include <string_view>

#include "analysis/settings/field.h"

namespace lacuna {

/// integrator: light.
struct LightSettings {
  static constexpr std::string_view name = "light";
  static constexpr std::string_view doc =
      "light tracing: paths from the lights, joined to the eye (Noel 2015, 4.2.5); what is seen "
      "through mirrors and clear glass stays black";

  /// Nothing is sampled from the eye: where little light happens to pass it, there is much noise.
  static constexpr bool from_lights_only = true;

  int max_depth = 6;
  int light_paths = 0;
  int roulette_depth = 8;

  bool operator==(const LightSettings&) const = default;
};

template <class V>
void describe(V& v, LightSettings& s) {
  v("max_depth", s.max_depth,
    {.doc = "longest path: 1 = emitters seen directly, 2 = direct light",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
  v("light_paths", s.light_paths,
    {.doc = "paths an iteration; 0: one for each pixel", .min = 0, .max = 1 << 20});
  v("roulette_depth", s.roulette_depth,
    {.doc = "paths longer than this may end by Russian roulette on their throughput",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
}

}  // namespace lacuna
