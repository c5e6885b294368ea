#pragma once

#include <string_view>

#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// integrator: path.
struct PathSettings {
  static constexpr std::string_view name = "path";
  static constexpr std::string_view doc =
      "path tracing with next event estimation and multiple importance sampling (Noel 2015, 4.2)";

  int max_depth = 6;
  GuideSettings guide = BsdfGuideSettings{};
  bool next_event_estimation = true;
  int roulette_depth = 8;

  bool operator==(const PathSettings&) const = default;
};

template <class V>
void describe(V& v, PathSettings& s) {
  v("max_depth", s.max_depth,
    {.doc = "longest path: 1 = emitters seen directly, 2 = direct light",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
  v("guide", s.guide, {.doc = "where the next ray goes"});
  v("next_event_estimation", s.next_event_estimation,
    {.doc = "also sample emitters at every vertex"});
  v("roulette_depth", s.roulette_depth,
    {.doc = "paths longer than this may end by Russian roulette on their throughput",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
}

}  // namespace lacuna
