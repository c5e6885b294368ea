#pragma once

#include "analysis/settings/field.h"

namespace lacuna {

/// How long paths get: settings of every method that walks them.
struct PathLengths {
  int max_depth = 6;
  int roulette_depth = 2;
  bool operator==(const PathLengths&) const = default;
};

template <class V>
void describe_lengths(V& v, PathLengths& s) {
  v("max_depth", s.max_depth,
    {.doc = "longest path: 1 = emitters seen directly, 2 = direct light",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
  v("roulette_depth", s.roulette_depth,
    {.doc = "after this many edges from the eye, or from a light, a path goes on with the "
            "probability of its throughput only (Russian roulette)",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
}

}  // namespace lacuna
