#pragma once

#include <array>
#include <string_view>
#include <variant>
#include <vector>

#include "base/settings/field.h"
#include "base/settings/retired_key.h"
#include "renderer/settings/integrator_settings.h"

namespace lacuna {

/// The integrators that estimate all light of a picture; not `light`, which cannot render mirrors.
using CandidateSettings =
    std::variant<PathSettings, BdptSettings, ManyLightsSettings, MetropolisSettings, VcmSettings,
                 SppmSettings, PhotonMapSettings>;

/// How much bias the candidates of `auto` may have.
enum class Allow { unbiased, consistent, biased };

template <>
struct EnumTable<Allow> {
  static constexpr std::array<EnumValue<Allow>, 3> values{{
      {Allow::unbiased, "unbiased", "no bias: the mean of many pictures is right"},
      {Allow::consistent, "consistent", "bias that vanishes with the number of iterations"},
      {Allow::biased, "biased", "any bias"},
  }};
};

/// Whether a candidate's settings have no more bias than is allowed.
inline bool is_allowed(const CandidateSettings& settings, Allow allow) {
  return allow == Allow::biased || !biased(settings) ||
         (allow == Allow::consistent && consistent(settings));
}

/// The error by which candidates are ranked, estimated from the two halves of their pictures.
enum class RankingMetric { relmse, mse };

template <>
struct EnumTable<RankingMetric> {
  static constexpr std::array<EnumValue<RankingMetric>, 2> values{{
      {RankingMetric::relmse, "relmse", "relative: dark regions count as well"},
      {RankingMetric::mse, "mse", "absolute: bright regions dominate"},
  }};
};

/// integrator: auto. Not a method of the renderer: jobs/run/choosing.h chooses one.
struct AutoSettings : PathLengths {
  static constexpr std::string_view name = "auto";
  static constexpr std::string_view doc =
      "the method with the smallest error on this picture: candidates render it in turns, the "
      "worse half is eliminated after each round, and the last one renders with the rest of the "
      "budget";
  static constexpr auto retired = std::to_array<RetiredKey>({
      {"regions", "true", "the job has one method"},
      {"sampling", "\"adaptive\"", "pixels have equal numbers of samples"},
      {"clock", "\"cpu_seconds\"", "jobs that only count iterations count rays as the cost"},
      {"remember", "true", "each job chooses by its own pictures"},
  });

  std::vector<CandidateSettings> candidates;
  Allow allow = Allow::unbiased;
  RankingMetric metric = RankingMetric::relmse;

  static std::string_view without_lengths() {
    return "chooses the method while it renders; `lacuna advise` names one";
  }
  static std::string_view without_letters() { return without_lengths(); }
  bool biased() const { return allow != Allow::unbiased; }
  bool consistent() const { return allow == Allow::consistent; }
  bool operator==(const AutoSettings&) const = default;
};

template <class V>
void describe(V& v, AutoSettings& s) {
  describe_lengths(v, s);
  v("candidates", s.candidates,
    {.doc = "integrators to choose from; they have the path lengths of `auto`, and may set no "
            "others. The first is the default: another is chosen if its expected error is less "
            "than half. Empty: `path` with `reuse` 64 and the guide "
            "`learned_skeleton`, `path` with `reuse` 16, `metropolis`, `bdpt` with `skeleton` and "
            "`many_lights` with `probabilistic`; where `allow` permits it `vcm` and `sppm`, and "
            "`photon_map` and "
            "`many_lights` with `view_maps`",
     .max = 32});
  v("allow", s.allow,
    {.doc = "the bias that candidates may have. It counts as error, measured as the difference to "
            "the best unbiased candidate; one must be unbiased"});
  v("metric", s.metric, {.doc = "the error by which candidates are ranked"});
}

}  // namespace lacuna
