#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <vector>

#include "analysis/complex/cubical_complex.h"

namespace lacuna {

/// What a collapse holds of a block beside the complex.
struct alignas(64) BorderBlock {
  std::array<Plane, 3> free_edges;  ///< by axis: edges that exactly one square contains
  Plane free_vertices;              ///< vertices that exactly one edge contains
  std::array<Plane, face_types>
      layer;      ///< the closed border L of Alg. 2, by face type (not vertices)
  Plane changed;  ///< cells whose faces were removed in this layer
};

/// Fills in the free edges and vertices of a block and returns its facet edges by axis. Depends on
/// faces up to one cell away.
std::array<Plane, 3> find_free(const CubicalComplex& complex, std::vector<BorderBlock>& border,
                               std::size_t block);

/// Fill in the layer L of a block: the closure of all faces that belong to a free pair. Cubes
/// first, then squares, then edges: each needs those before it of the blocks below along each axis,
/// and the free faces of the blocks above. So one ascending walk may take all three at each block.
void border_cubes(const CubicalComplex& complex, std::vector<BorderBlock>& border,
                  std::size_t block);
void border_squares(const CubicalComplex& complex, std::vector<BorderBlock>& border,
                    std::size_t block);
/// Returns the cells where L has any face but vertices.
Plane border_edges(const CubicalComplex& complex, std::vector<BorderBlock>& border,
                   std::size_t block);

/// The neighbouring blocks, as steps from `low` to `high` along each axis, that what lies within
/// two cells of the given cells reaches into.
struct Reach {
  Imath::V3i low, high;
};
Reach reach_of(const Plane& cells);

}  // namespace lacuna
