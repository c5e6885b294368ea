#pragma once

#include <functional>

#include "analysis/geometry/grid.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

enum class SweepDirection { ascending, descending };

/// Runs `body(i)` for i in [0, n), without the pool if it cannot help.
void run_parallel(const ThreadPool& pool, int n, const std::function<void(int)>& body);

/// One pass over the planes of a grid where plane z depends on the plane before it, z - 1
/// (ascending) or z + 1.
struct PlaneSweep {
  Imath::V3i size;
  SweepDirection direction;
  int reach;  ///< a row depends on rows up to this distance in the plane before: 0 or 1
  /// Called once for every plane before its steps, in any order, also while steps of earlier planes
  /// have not run. May be empty.
  std::function<void(int z)> prepare;
  /// Rows [y0, y1) of plane z, when rows [y0 - reach, y1 + reach) of the plane before are done.
  std::function<void(int z, int y0, int y1)> step;
};

/// Each thread processes a block of rows through several planes: the block shrinks by `reach` rows
/// per plane, and the gaps between blocks, which grow at the same rate, are filled afterwards. So
/// threads synchronise once in many planes.
void sweep(const PlaneSweep& pass, const ThreadPool& pool);

}  // namespace lacuna
