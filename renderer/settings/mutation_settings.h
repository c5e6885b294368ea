#pragma once

#include <string_view>
#include <variant>

#include "analysis/settings/field.h"

namespace lacuna {

/// What mutations in primary sample space have in common.
struct PrimaryStepSettings {
  double step = 0x1p-5;
  int octaves = 8;
  double large_steps = 0.05;
  bool operator==(const PrimaryStepSettings&) const = default;
};
template <class V>
void describe_steps(V& v, PrimaryStepSettings& s) {
  v("step", s.step,
    {.doc = "largest change of a random number in a small step", .min = 1e-6, .max = 0.5});
  v("octaves", s.octaves,
    {.doc = "each small step divides `step` by a power of two below 2^octaves, drawn at random",
     .min = 1,
     .max = 16});
  v("large_steps", s.large_steps,
    {.doc = "probability of a step that is independent of the state", .min = 0, .max = 1});
}

/// mutation: multiplexed.
struct MultiplexedSettings : PrimaryStepSettings {
  static constexpr std::string_view name = "multiplexed";
  static constexpr std::string_view doc =
      "changes the random numbers of a path; the strategy that samples it is one of them "
      "(Hachisuka et al. 2014)";
  bool operator==(const MultiplexedSettings&) const = default;
};
template <class V>
void describe(V& v, MultiplexedSettings& s) {
  describe_steps(v, s);
}

/// mutation: primary_sample.
struct PrimarySampleSettings : PrimaryStepSettings {
  static constexpr std::string_view name = "primary_sample";
  static constexpr std::string_view doc =
      "changes the random numbers of an eye path and a light path, which are joined in all ways "
      "(Kelemen et al. 2002; Noel 2015, 4.6)";
  bool operator==(const PrimarySampleSettings&) const = default;
};
template <class V>
void describe(V& v, PrimarySampleSettings& s) {
  describe_steps(v, s);
}

/// How a chain's next path is proposed.
using MutationSettings = std::variant<MultiplexedSettings, PrimarySampleSettings>;

}  // namespace lacuna
