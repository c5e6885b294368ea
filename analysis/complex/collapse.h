#pragma once

#include <array>
#include <limits>

#include "analysis/complex/border.h"
#include "analysis/complex/kept_edges.h"
#include "analysis/parallel/thread_pool.h"

namespace lacuna {

/// Is told of edges after every layer of a collapse, from several threads at once, of each block
/// from one at a time.
class LayerObserver {
 public:
  virtual ~LayerObserver() = default;
  /// After `date` layers, for a block in which something may have changed: the edges that are
  /// there, and those of them that no square contains (facets), by axis.
  virtual void edges(int date, std::size_t block, const std::array<Plane, 3>& present,
                     const std::array<Plane, 3>& facets) = 0;
};

/// What collapse() takes beside the complex.
inline constexpr std::uint64_t collapse_bytes_per_block = sizeof(BorderBlock);

inline constexpr int all_layers = std::numeric_limits<int>::max();

/// ParDirCollapse (thesis Alg. 2), in place: removes at most `layers` layers of free pairs that lie
/// on the border as it is before each layer, in the thesis' order: by axis, then orientation, then
/// dimension from 3 to 1. Homotopic. Returns the number of layers in which something was removed.
/// Linear in the number of faces: a block costs only in layers near which something changed. The
/// same bits with any pool, or none.
int collapse(CubicalComplex& complex, const KeptEdges& kept, LayerObserver* observer = nullptr,
             int layers = all_layers, const ThreadPool* pool = nullptr);

}  // namespace lacuna
