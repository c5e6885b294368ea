#pragma once

#include <array>
#include <limits>

#include "analysis/complex/border.h"
#include "analysis/complex/kept_edges.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// Observes the edges after every layer of a collapse. Called by several threads at once, but for
/// each block by one at a time.
class LayerObserver {
 public:
  virtual ~LayerObserver() = default;
  /// Called after `date` layers for every block that may have changed: the edges present, and those
  /// of them that no square contains (facets), by axis.
  virtual void edges(int date, std::size_t block, const std::array<Plane, 3>& present,
                     const std::array<Plane, 3>& facets) = 0;
};

/// Memory that collapse() needs besides the complex.
inline constexpr std::uint64_t collapse_bytes_per_block = sizeof(BorderBlock);

inline constexpr int all_layers = std::numeric_limits<int>::max();

/// ParDirCollapse (thesis Alg. 2), in place: removes at most `layers` layers of free pairs, each of
/// the border at the start of the layer, in the thesis' order: by axis, then orientation, then
/// dimension from 3 to 1. Preserves the homotopy type. Returns the number of layers in which faces
/// were removed. Linear in the number of faces: a block is processed only in layers near changes.
/// The same bits with any pool, or none.
int collapse(CubicalComplex& complex, const KeptEdges& kept, LayerObserver* observer = nullptr,
             int layers = all_layers, const ThreadPool* pool = nullptr);

}  // namespace lacuna
