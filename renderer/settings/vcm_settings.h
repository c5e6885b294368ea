#pragma once

#include <string_view>
#include <type_traits>
#include <variant>

#include "renderer/settings/connections_settings.h"
#include "renderer/settings/guide_settings.h"
#include "renderer/settings/light_guide_settings.h"
#include "renderer/settings/output_settings.h"
#include "renderer/settings/path_lengths.h"
#include "renderer/settings/photon_settings.h"

namespace lacuna {

/// connections: paired, of `vcm`: emitters are sampled by power, because a photon does not store
/// what the light tree needs.
struct PairedByPowerSettings {
  static constexpr std::string_view name = "paired";
  static constexpr std::string_view doc =
      "every eye path is connected to its own light path, which is also one of the photons";
  bool operator==(const PairedByPowerSettings&) const = default;
};
template <class V>
void describe(V&, PairedByPowerSettings&) {}

/// How `vcm` samples light vertices for connections.
using VcmConnections =
    std::variant<PairedByPowerSettings, UniformSettings, SkeletonConnectionsSettings,
                 ImportanceCacheSettings, ProbabilisticConnectionsSettings, HybridSettings>;

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
  VcmConnections connections = PairedByPowerSettings{};
  GuideSettings guide = BsdfGuideSettings{};
  LightGuideSettings light_guide = BsdfGuideSettings{};

  bool biased() const { return merge || lacuna::biased(guide); }
  std::string_view conflict() const {
    if (connect || std::holds_alternative<PairedByPowerSettings>(connections)) return {};
    return "\"connect\": false with resampled connections; allowed: \"paired\" connections, or "
           "\"connect\": true";
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
            "`paired` connections, bit for bit"});
  v("connect", s.connect,
    {.doc = "connect the vertices of eye and light paths, light paths to the eye, and eye paths to "
            "points on emitters. Otherwise the method is bidirectional photon mapping"});
  v("connections", s.connections, {.doc = "how light vertices are sampled for an eye vertex"});
  describe_radius(v, s);
  describe_alpha(v, s);
  v("guide", s.guide, {.doc = "how the next direction of an eye path is sampled"});
  describe_light_guide(v, s.light_guide);
}

/// The connections of `vcm` as those of `bdpt`.
inline ConnectionsSettings connections_of(const VcmSettings& settings) {
  return std::visit(
      []<class S>(const S& s) -> ConnectionsSettings {
        if constexpr (std::is_same_v<S, PairedByPowerSettings>) {
          return PairedSettings{};
        } else {
          return s;
        }
      },
      settings.connections);
}

}  // namespace lacuna
