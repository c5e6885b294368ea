#pragma once

#include <string_view>

#include "renderer/settings/mutation_settings.h"
#include "renderer/settings/path_lengths.h"

namespace lacuna {

/// integrator: metropolis.
struct MetropolisSettings : PathLengths {
  static constexpr std::string_view name = "metropolis";
  static constexpr bool spreads_samples = false;  // all numbers are independent
  static constexpr std::string_view doc =
      "Metropolis light transport: Markov chains of paths, distributed in proportion to their "
      "contribution (Noel 2015, 4.6)";

  MutationSettings mutation = PathSpaceSettings{};
  int chains = 256;
  double mutations = 8;
  double bootstrap = 1;
  int direct_samples = 0;

  bool operator==(const MetropolisSettings&) const = default;
};

template <class V>
void describe(V& v, MetropolisSettings& s) {
  describe_lengths(v, s);
  v("mutation", s.mutation, {.doc = "how the next path of a chain is proposed"});
  v("chains", s.chains,
    {.doc = "chains per iteration; in each iteration they start from independent samples with a "
            "contribution",
     .min = 1,
     .max = 1 << 17});
  v("mutations", s.mutations,
    {.doc = "mutations per pixel and iteration, over all chains", .min = 0.01, .max = 1000});
  v("bootstrap", s.bootstrap,
    {.doc = "independent samples per pixel and iteration, which estimate the brightness of the "
            "picture and provide the starts of chains; in total at least the number of chains",
     .min = 0.001,
     .max = 100});
  v("direct_samples", s.direct_samples,
    {.doc =
         "path-traced samples per pixel and iteration of directly visible emitters and of direct "
         "light; chains then sample longer paths only. 0: chains sample direct light, too, and "
         "only directly visible emitters are path-traced; better if most direct light is occluded",
     .min = 0,
     .max = 1000});
}

}  // namespace lacuna
