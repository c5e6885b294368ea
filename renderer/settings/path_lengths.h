#pragma once

#include "base/settings/field.h"

namespace lacuna {

/// The limits of path length: settings of every method that traces paths.
struct PathLengths {
  int max_depth = 6;
  /// If light arrives around corners, roulette adds more noise than its time savings compensate: at
  /// equal time on corridor, 2 has 2.7 times the squared error of 6 with `light`, 2.3 times with
  /// `path` and, relative to the pixel, 1.5 times with `bdpt`; on door they differ by at most a
  /// fifth.
  int roulette_depth = 6;
  bool operator==(const PathLengths&) const = default;
};

template <class V>
void describe_lengths(V& v, PathLengths& s) {
  v("max_depth", s.max_depth,
    {.doc = "longest path: 1 = directly visible emitters, 2 = direct light",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
  v("roulette_depth", s.roulette_depth,
    {.doc = "Russian roulette starts after this many edges from the eye or from a light: a path "
            "continues with a probability equal to its throughput; a guided path, with its "
            "expected further contribution relative to that at its first vertex",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
}

}  // namespace lacuna
