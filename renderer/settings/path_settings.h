#pragma once

#include <string_view>

#include "renderer/settings/emitter_settings.h"
#include "renderer/settings/guide_settings.h"
#include "renderer/settings/path_lengths.h"
#include "renderer/settings/roulette_settings.h"
#include "renderer/settings/sampling_settings.h"

namespace lacuna {

/// integrator: path.
struct PathSettings : PathLengths {
  static constexpr std::string_view name = "path";
  static constexpr std::string_view doc =
      "path tracing with next event estimation and multiple importance sampling (Noel 2015, 4.2)";

  GuideSettings guide = BsdfGuideSettings{};
  bool next_event_estimation = true;
  Sampling sampling = Sampling::uniform;
  EmitterChoice emitters = EmitterChoice::automatic;
  RouletteChoice roulette = RouletteChoice::throughput;

  bool biased() const { return lacuna::biased(guide); }
  bool operator==(const PathSettings&) const = default;
};

template <class V>
void describe(V& v, PathSettings& s) {
  describe_lengths(v, s);
  v("guide", s.guide, {.doc = "how the next direction is sampled"});
  v("next_event_estimation", s.next_event_estimation,
    {.doc = "also sample a point on an emitter at every vertex"});
  v("sampling", s.sampling, {.doc = "how many samples the pixels get"});
  describe_emitters(v, s.emitters);
  v("roulette", s.roulette, {.doc = "what decides how often a path goes on"});
}

}  // namespace lacuna
