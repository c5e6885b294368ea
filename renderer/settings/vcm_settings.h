#pragma once

#include <string_view>
#include <variant>

#include "renderer/settings/connections_settings.h"
#include "renderer/settings/guide_settings.h"
#include "renderer/settings/light_guide_settings.h"
#include "renderer/settings/output_settings.h"
#include "renderer/settings/path_lengths.h"
#include "renderer/settings/photon_settings.h"

namespace lacuna {

/// integrator: vcm.
struct VcmSettings : PathLengths, RadiusSettings {
  static constexpr std::string_view name = "vcm";
  static constexpr std::string_view doc =
      "bidirectional path tracing that also merges eye vertices with the vertices of all light "
      "paths: vertex connection and merging (Georgiev et al. 2012; Hachisuka et al. 2012)";

  static constexpr std::array layers{ImageLayer::strategies, ImageLayer::strategies_unweighted,
                                     ImageLayer::distributions};

  bool merge = true;
  bool connect = true;
  ConnectionsSettings connections = PairedSettings{};
  GuideSettings guide = BsdfGuideSettings{};
  LightGuideSettings light_guide = BsdfGuideSettings{};

  bool biased() const { return merge || lacuna::biased(guide); }
  std::string_view conflict() const {
    const auto* paired = std::get_if<PairedSettings>(&connections);
    if (paired == nullptr && !connect) {
      return "\"connect\": false with resampled connections; allowed: \"paired\" connections, or "
             "\"connect\": true";
    }
    if (paired != nullptr && merge && paired->emitters == EmitterChoice::tree) {
      return "\"emitters\": \"tree\" with \"merge\", because a photon does not store what it "
             "needs; allowed: \"power\"";
    }
    return {};
  }
  /// The bias of merging vanishes with the radius; the bias of a guide does not.
  bool consistent() const { return RadiusSettings::consistent() && !lacuna::biased(guide); }
  bool operator==(const VcmSettings&) const = default;
};

template <class V>
void describe(V& v, VcmSettings& s) {
  describe_lengths(v, s);
  v("merge", s.merge,
    {.doc = "merge eye vertices with nearby light vertices. Otherwise the method is `bdpt` with "
            "the same connections, bit for bit"});
  v("connect", s.connect,
    {.doc = "connect the vertices of eye and light paths, light paths to the eye, and eye paths to "
            "points on emitters. Otherwise the method is bidirectional photon mapping"});
  v("connections", s.connections,
    {.doc = "how light vertices are sampled for an eye vertex. With `merge`, `paired` samples "
            "emitters by power, and a new point on one for each eye vertex"});
  describe_radius(v, s);
  describe_alpha(v, s);
  v("guide", s.guide, {.doc = "how the next direction of an eye path is sampled"});
  describe_light_guide(v, s.light_guide);
}

}  // namespace lacuna
