#pragma once

#include <string_view>
#include <variant>

#include "base/settings/field.h"

namespace lacuna {

/// Settings common to mutations in primary sample space.
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
    {.doc = "each small step divides `step` by a random power of two below 2^octaves",
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
      "changes the random numbers of an eye path and a light path, which are connected by all "
      "strategies (Kelemen et al. 2002; Noel 2015, 4.6)";
  bool operator==(const PrimarySampleSettings&) const = default;
};
template <class V>
void describe(V& v, PrimarySampleSettings& s) {
  describe_steps(v, s);
}

/// mutation: path_space.
struct PathSpaceSettings {
  static constexpr std::string_view name = "path_space";
  static constexpr std::string_view doc =
      "changes some vertices of a path: replaces a part of it, or rotates one of its directions "
      "(Veach and Guibas 1997)";

  double large_steps = 0.01;
  double bidirectional = 0.15;
  double lens = 0.83;
  double largest_angle = 0.5;
  double largest_lens = 0.1;
  double octaves = 5;
  double least_tested = 0.1;
  bool operator==(const PathSpaceSettings&) const = default;
};
template <class V>
void describe(V& v, PathSpaceSettings& s) {
  v("large_steps", s.large_steps,
    {.doc = "probability of a proposal that is independent of the state", .min = 0, .max = 1});
  v("bidirectional", s.bidirectional,
    {.doc = "probability of replacing a part of the path, among proposals that depend on the "
            "state; the others are perturbations",
     .min = 0,
     .max = 1});
  v("lens", s.lens,
    {.doc = "probability that a perturbation moves the path on the film; the others rotate the "
            "direction between two of its vertices",
     .min = 0,
     .max = 1});
  v("largest_angle", s.largest_angle,
    {.doc =
         "largest angle by which a direction is rotated, radians; a ray from infinity is shifted "
         "sideways by the same fraction of its distance to the next vertex that scatters",
     .min = 1e-6,
     .max = 3});
  v("largest_lens", s.largest_lens,
    {.doc = "largest distance that a path moves on the film, in heights of the picture",
     .min = 1e-6,
     .max = 1});
  v("octaves", s.octaves,
    {.doc = "both distances are divided by a power of 2, its exponent uniform in 0 to `octaves`",
     .min = 0,
     .max = 20});
  v("least_tested", s.least_tested,
    {.doc = "a proposal whose acceptance probability is below this is tested by a shadow ray only "
            "with some probability (Russian roulette)",
     .min = 0,
     .max = 1,
     .above_min = true});
}

/// How a chain's next path is proposed.
using MutationSettings =
    std::variant<MultiplexedSettings, PrimarySampleSettings, PathSpaceSettings>;

}  // namespace lacuna
