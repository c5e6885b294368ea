#pragma once

#include <array>
#include <variant>
#include <vector>

#include "base/settings/field.h"
#include "renderer/settings/bdpt_settings.h"
#include "renderer/settings/many_lights_settings.h"
#include "renderer/settings/metropolis_settings.h"
#include "renderer/settings/path_lengths.h"
#include "renderer/settings/path_settings.h"
#include "renderer/settings/photon_mapping_settings.h"
#include "renderer/settings/sampling_settings.h"
#include "renderer/settings/vcm_settings.h"

namespace lacuna {

/// The integrators that estimate all light of a picture. `light` is not among them: it does not see
/// mirrors.
using CandidateSettings =
    std::variant<PathSettings, BdptSettings, ManyLightsSettings, MetropolisSettings, VcmSettings,
                 SppmSettings, PhotonMapSettings>;

/// What the candidates of a race may have.
enum class Allow { unbiased, consistent, biased };

template <>
struct EnumTable<Allow> {
  static constexpr std::array<EnumValue<Allow>, 3> values{{
      {Allow::unbiased, "unbiased", "no bias: the mean of many pictures is right"},
      {Allow::consistent, "consistent", "bias that vanishes with the number of iterations"},
      {Allow::biased, "biased", "any bias"},
  }};
};

/// What a race counts as cost.
enum class RaceClock { cpu_seconds, rays };

template <>
struct EnumTable<RaceClock> {
  static constexpr std::array<EnumValue<RaceClock>, 2> values{{
      {RaceClock::cpu_seconds, "cpu_seconds",
       "CPU seconds. Clocks differ from run to run, and so may decisions"},
      {RaceClock::rays, "rays",
       "rays traced, in three rounds: the same bits in every run. A ray of each method counts "
       "alike"},
  }};
};

/// integrator: auto.
struct AutoSettings : PathLengths {
  static constexpr std::string_view name = "auto";
  static constexpr std::string_view doc =
      "the method that this picture needs: candidates race on it, and the winner, or several that "
      "share its regions, render it";

  std::vector<CandidateSettings> candidates;
  Allow allow = Allow::unbiased;
  bool regions = true;
  Sampling sampling = Sampling::adaptive;
  RaceClock clock = RaceClock::cpu_seconds;
  bool remember = true;

  bool biased() const { return allow != Allow::unbiased; }
  bool consistent() const { return allow == Allow::consistent; }
  bool operator==(const AutoSettings&) const = default;
};

template <class V>
void describe(V& v, AutoSettings& s) {
  describe_lengths(v, s);
  v("candidates", s.candidates,
    {.doc = "integrators that race; they take the lengths of paths from here, and may name no "
            "others. Empty: `path`, `metropolis`, `bdpt`, and, where the budget is worth an "
            "analysis of the space, `bdpt` with `skeleton` and `many_lights` with "
            "`probabilistic`; where `allow` says so `vcm` and `sppm`, and `photon_map` and "
            "`many_lights` with `view_maps`",
     .max = 32});
  v("allow", s.allow,
    {.doc = "what the candidates may have. Bias, the difference to the unbiased candidates, counts "
            "as error; one unbiased candidate must race"});
  v("regions", s.regions, {.doc = "several methods may share the time, each where it is best"});
  v("sampling", s.sampling,
    {.doc = "how many samples the pixels get from candidates whose light paths do not serve all "
            "pixels: `path`"});
  v("clock", s.clock, {.doc = "what the race counts as cost"});
  v("remember", s.remember,
    {.doc = "with a budget in seconds, what the race finds is kept in the cache: the next job of "
            "this picture at a similar budget leaves out those that were surely worse by a factor "
            "of 2, and their preparation"});
}

}  // namespace lacuna
