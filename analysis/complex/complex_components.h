#pragma once

#include "analysis/complex/cubical_complex.h"
#include "analysis/space/run_components.h"

namespace lacuna {

/// The complement of a complex as components of missing cubes, two of them linked where the square
/// between them is missing; the grid has one cell more on every side, which belong to the outside.
class ComplementComponents {
 public:
  explicit ComplementComponents(const CubicalComplex& complex,
                                const ThreadPool& pool = ThreadPool(1));

  /// Cavities and the outside.
  std::uint32_t count() const { return static_cast<std::uint32_t>(components_.count()); }
  /// Of the missing cube at `cell`, in [-1, size].
  std::uint32_t of(Imath::V3i cell) const { return components_.at(cell + Imath::V3i(1)); }
  /// What everything outside the grid belongs to.
  std::uint32_t outside() const { return of(Imath::V3i(-1)); }

 private:
  RunComponents components_;
};

/// Number of connected components of a complex.
std::uint32_t component_count(const CubicalComplex& complex);

}  // namespace lacuna
