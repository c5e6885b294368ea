#pragma once

#include <array>
#include <variant>
#include <vector>

#include "analysis/settings/field.h"
#include "renderer/settings/bdpt_settings.h"
#include "renderer/settings/many_lights_settings.h"
#include "renderer/settings/metropolis_settings.h"
#include "renderer/settings/path_lengths.h"
#include "renderer/settings/path_settings.h"

namespace lacuna {

/// The integrators that estimate all light of a picture without bias, as far as their settings
/// allow. `light` is not among them: it does not see mirrors.
using CandidateSettings =
    std::variant<PathSettings, BdptSettings, ManyLightsSettings, MetropolisSettings>;

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
  bool regions = true;
  RaceClock clock = RaceClock::cpu_seconds;

  bool operator==(const AutoSettings&) const = default;
};

template <class V>
void describe(V& v, AutoSettings& s) {
  describe_lengths(v, s);
  v("candidates", s.candidates,
    {.doc = "unbiased integrators that race; they take the lengths of paths from here, and may "
            "name no others. Empty: `path`, `metropolis`, `bdpt`, and, where the budget is worth "
            "an analysis of the space, `bdpt` with `skeleton` and `many_lights` with "
            "`probabilistic`",
     .max = 32});
  v("regions", s.regions, {.doc = "several methods may share the time, each where it is best"});
  v("clock", s.clock, {.doc = "what the race counts as cost"});
}

}  // namespace lacuna
