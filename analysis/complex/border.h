#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <vector>

#include "analysis/complex/cubical_complex.h"

namespace lacuna {

/// The data of a block that a collapse needs in addition to the complex.
struct alignas(64) BorderBlock {
  std::array<Plane, 3> free_edges;  ///< by axis: edges that exactly one square contains
  Plane free_vertices;              ///< vertices that exactly one edge contains
  Plane changed;                    ///< cells whose faces were removed in this layer
  std::array<Plane, face_types - 1> layers;

  /// The closed border L of Alg. 2, of one type of face (not vertices).
  Plane& layer(FaceType m) { return layers[static_cast<std::size_t>(m) - 1]; }
  const Plane& layer(FaceType m) const { return layers[static_cast<std::size_t>(m) - 1]; }
};

/// Fills in the free edges and vertices of a block and returns its facet edges by axis. Depends on
/// faces up to one cell away.
std::array<Plane, 3> find_free(const CubicalComplex& complex, std::vector<BorderBlock>& border,
                               std::size_t block);

/// Fills in the layer L of a block, the closure of all faces that belong to a free pair, and
/// returns the cells that have such faces. Requires the L of the preceding blocks along each axis,
/// and the free edges and vertices of the following ones.
Plane take_border_of(const CubicalComplex& complex, std::vector<BorderBlock>& border,
                     std::size_t block);

/// The neighbouring blocks, as offsets from `low` to `high` along each axis, that contain cells
/// within two cells of the given ones.
struct Reach {
  Imath::V3i low, high;
};
Reach reach_of(const Plane& cells);

}  // namespace lacuna
