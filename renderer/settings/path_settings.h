#pragma once

#include <array>
#include <string_view>

#include "base/settings/retired_key.h"
#include "renderer/settings/departures.h"
#include "renderer/settings/emitter_settings.h"
#include "renderer/settings/guide_settings.h"
#include "renderer/settings/path_lengths.h"

namespace lacuna {

/// integrator: path.
struct PathSettings : PathLengths {
  static constexpr std::string_view name = "path";
  static constexpr std::string_view doc =
      "path tracing with next event estimation and multiple importance sampling (Noel 2015, 4.2)";
  static constexpr auto retired = std::to_array<RetiredKey>({
      {"sampling", "\"uniform\"", "pixels have equal numbers of samples"},
      {"roulette", "\"throughput\"", "paths end by their throughput, guided ones within a window"},
  });

  GuideSettings guide = BsdfGuideSettings{};
  bool next_event_estimation = true;
  EmitterChoice emitters = EmitterChoice::automatic;
  int reuse = 1;
  Heuristic heuristic = Heuristic::power;  // differs from the published value

  /// Why these settings are incompatible; empty if they are compatible.
  std::string_view conflict() const {
    if (reuse > 1 && roulette_depth < 2) {
      return "pixels that share light, with roulette at their first vertex; allowed: "
             "roulette_depth 2 or more, or reuse 1";
    }
    return {};
  }

  std::string_view without_letters() const {
    return reuse > 1
               ? "connects the ends of paths to those of other pixels (\"reuse\"), with other "
                 "letters"
               : "";
  }
  bool biased() const { return lacuna::biased(guide); }
  bool operator==(const PathSettings&) const = default;
};

template <class V>
void describe(V& v, PathSettings& s) {
  describe_lengths(v, s);
  v("guide", s.guide, {.doc = "how the next direction is sampled"});
  v("next_event_estimation", s.next_event_estimation,
    {.doc = "also sample a point on an emitter at every vertex"});
  describe_emitters(v, s.emitters);
  v("reuse", s.reuse,
    {.doc = "number of pixels of a block of 8 x 8 that share the light gathered by their paths "
            "behind the second surface, by shadow rays to it (Bekaert et al. 2002); 1: no sharing. "
            "Requires roulette_depth 2 or more",
     .min = 1,
     .max = 64,
     .unit = "pixels"});
  describe_heuristic(v, s.heuristic);
}

}  // namespace lacuna
