#pragma once

#include "analysis/complex/cubical_complex.h"
#include "analysis/complex/keep_rule.h"
#include "analysis/space/memory_limit.h"

namespace lacuna {

/// Counts of the computation of a skeleton.
struct ThinningReport {
  int layers = 0;              ///< of the first collapse: the depth of the space
  std::size_t kept_edges = 0;  ///< edges of W before piercing
  std::size_t openings_asked = 0;
  int pierce_rounds = 0;  ///< 0: the space had no surface left
  std::size_t squares_pierced = 0;
};

/// A thin complex and the edges W that it was thinned with.
struct ThinComplex {
  CubicalComplex complex;
  KeptEdges kept;
};

/// CurvilinearSkeleton (thesis Alg. 3): keeps the edges of KeepRule and collapses the rest.
/// Homotopic to the closure of `domain`; may contain squares around cavities.
ThinComplex thin(const BitGrid3& domain, const SpaceMaps& maps, ThinningReport& report,
                 const ThreadPool* pool = nullptr);

/// thin(), then pierced (6.2.4) and thinned again until it is a graph of vertices and edges only.
/// After each round the keep rule is evaluated again on the pierced complex, with the distances of
/// the original voxels, and the old edges stay kept. With the old edges alone a closed surface
/// would shrink to the point where a curve meets it, and the space around a floating object would
/// have no node.
///
/// Throws MemoryLimitError, before it allocates, if it would take more than `byte_limit` bytes.
CubicalComplex curvilinear_skeleton(const BitGrid3& domain, const SpaceMaps& maps,
                                    ThinningReport& report, const ThreadPool* pool = nullptr,
                                    std::uint64_t byte_limit = no_memory_limit);

}  // namespace lacuna
