#pragma once

#include "analysis/settings/field.h"

namespace lacuna {

/// How long paths get: settings of every method that walks them.
struct PathLengths {
  int max_depth = 6;
  /// Where light comes round corners, ending paths costs more noise than its time saves: at equal
  /// time on corridor, 2 has 2.7 times the squared error of 6 with `light`, 2.3 times with `path`
  /// and, relative to the pixel, 1.5 times with `bdpt`; on door theirs differ by a fifth at most.
  int roulette_depth = 6;
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
            "probability of its throughput only (Russian roulette); of a guided path, what the "
            "BSDF's own draws would have left of it",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
}

}  // namespace lacuna
