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
      "Metropolis light transport: Markov chains of paths that follow the light (Noel 2015, 4.6)";

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
    {.doc =
         "chains of an iteration; they start anew in each, where independent samples found light",
     .min = 1,
     .max = 1 << 17});
  v("mutations", s.mutations,
    {.doc = "mutations for each pixel in an iteration, all chains together",
     .min = 0.01,
     .max = 1000});
  v("bootstrap", s.bootstrap,
    {.doc = "independent samples for each pixel in an iteration, which give the brightness of the "
            "picture and the starts of chains; as many as chains at least",
     .min = 0.001,
     .max = 100});
  v("direct_samples", s.direct_samples,
    {.doc =
         "path traced samples for each pixel in an iteration, of emitters seen directly and of "
         "direct light; chains follow longer paths only. 0: chains follow direct light, too, and "
         "only emitters seen directly are sampled; better where little of it is unoccluded",
     .min = 0,
     .max = 1000});
}

}  // namespace lacuna
