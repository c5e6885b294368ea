#pragma once

#include <functional>

#include "analysis/geometry/grid.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

enum class SweepDirection { ascending, descending };

/// Runs `body(i)` for i in [0, n), without the pool where it cannot help.
void run_parallel(const ThreadPool& pool, int n, const std::function<void(int)>& body);

/// One pass over the planes of a grid where plane z depends on the plane before it, z - 1
/// (ascending) or z + 1.
struct PlaneSweep {
  Imath::V3i size;
  SweepDirection direction;
  int reach;  ///< a row depends on rows up to so far from it in the plane before: 0 or 1
  /// Called once for every plane before its steps, in any order, also while steps of earlier planes
  /// have not run. May be empty.
  std::function<void(int z)> prepare;
  /// Rows [y0, y1) of plane z, when rows [y0 - reach, y1 + reach) of the plane before are done.
  std::function<void(int z, int y0, int y1)> step;
};

/// Threads take blocks of rows through several planes at a time: each block shrinks by `reach` rows
/// a plane, then the gaps between blocks, which grow as fast, are filled. So threads meet once in
/// many planes.
void sweep(const PlaneSweep& pass, const ThreadPool& pool);

}  // namespace lacuna
