#pragma once

#include <string_view>

#include "renderer/settings/connections_settings.h"
#include "renderer/settings/guide_settings.h"
#include "renderer/settings/light_guide_settings.h"
#include "renderer/settings/output_settings.h"
#include "renderer/settings/path_lengths.h"

namespace lacuna {

/// integrator: bdpt.
struct BdptSettings : PathLengths {
  static constexpr std::string_view name = "bdpt";
  static constexpr std::string_view doc =
      "bidirectional path tracing with all strategies (Noel 2015, 4.3), and with resampled "
      "connections (ch. 11)";

  static constexpr std::array layers{ImageLayer::strategies, ImageLayer::strategies_unweighted,
                                     ImageLayer::distributions};

  ConnectionsSettings connections = PairedSettings{};
  GuideSettings guide = BsdfGuideSettings{};
  LightGuideSettings light_guide = BsdfGuideSettings{};

  bool biased() const { return lacuna::biased(guide); }
  bool operator==(const BdptSettings&) const = default;
};

template <class V>
void describe(V& v, BdptSettings& s) {
  describe_lengths(v, s);
  v("connections", s.connections, {.doc = "how light vertices are sampled for an eye vertex"});
  v("guide", s.guide, {.doc = "how the next direction of an eye path is sampled"});
  describe_light_guide(v, s.light_guide);
}

}  // namespace lacuna
