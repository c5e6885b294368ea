#pragma once

#include <string_view>

#include "renderer/settings/connections_settings.h"
#include "renderer/settings/guide_settings.h"
#include "renderer/settings/output_settings.h"

namespace lacuna {

/// integrator: bdpt.
struct BdptSettings {
  static constexpr std::string_view name = "bdpt";
  static constexpr std::string_view doc =
      "bidirectional path tracing with all strategies (Noel 2015, 4.3), and with resampled "
      "connections (ch. 11)";

  static constexpr std::array layers{ImageLayer::strategies, ImageLayer::strategies_unweighted,
                                     ImageLayer::distributions};

  int max_depth = 6;
  ConnectionsSettings connections = PairedSettings{};
  GuideSettings guide = BsdfGuideSettings{};
  int roulette_depth = 8;

  bool operator==(const BdptSettings&) const = default;
};

template <class V>
void describe(V& v, BdptSettings& s) {
  v("max_depth", s.max_depth,
    {.doc = "longest path: 1 = emitters seen directly, 2 = direct light",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
  v("connections", s.connections, {.doc = "which light vertices meet an eye vertex"});
  v("guide", s.guide, {.doc = "where the next ray of a path from the eye goes"});
  v("roulette_depth", s.roulette_depth,
    {.doc = "paths longer than this, from the eye or a light, may end by Russian roulette on their "
            "throughput",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
}

}  // namespace lacuna
