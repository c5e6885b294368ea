#pragma once

#include <vector>

#include "analysis/complex/cubical_complex.h"
#include "analysis/geometry/grid.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// A square of a complex.
struct Square {
  Imath::V3i cell;
  FaceType type;
};

/// The squares to remove from a thin complex (one without cubes) so that thinning can go on
/// (thesis 6.2.4). The thesis removes one square from each connected part of the surface and thins
/// again, until no square is left. This chooses all of them at once: in order of decreasing
/// distance to the scene, a square is taken if it joins two components of the complement that are
/// still separate (a spanning forest), so every cavity is opened and no tunnel is made. Where
/// squares bound no cavity, it takes the square of largest distance of each connected part. Empty
/// only if there is no square. Deterministic.
std::vector<Square> squares_to_pierce(const CubicalComplex& thin,
                                      const Grid3<std::uint16_t>& distance,
                                      const ThreadPool* pool = nullptr);

}  // namespace lacuna
