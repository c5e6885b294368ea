#pragma once

#include <cmath>

#include "renderer/core/vec.h"

namespace lacuna {

// Rays leave a surface from a point beside it, so that they do not hit it again. The least distance
// that is safe follows from what is rounded; nothing else of the scene, its size included, enters.
// With u = 2^-24, the largest relative error of rounding to float:
//
// - A point x on the plane is rounded once, and the origin beside it once more. Across the plane,
//   each moves it by at most u sum_i |ng_i x_i|.
// - Embree computes the distance of an origin from the plane of a triangle with an error that
//   TriangleShape::plane_error bounds.
// - The direction of a segment, end - start, is rounded by u times its length, and Embree's
//   distance along it by a few u: the end of a segment is moved by its length times these as well.
//
// Each bound is doubled. Both first ones are 0 for a horizontal floor at height 0, however large.

/// The distance from the surface at which rays start at `x`, scene units. `ng`: unit normal;
/// `plane_error`: that of the triangle.
inline float ray_offset(const V3f& x, const V3f& ng, float plane_error) {
  constexpr float two_roundings = 0x1p-22F;
  return plane_error +
         two_roundings * (std::abs(ng.x * x.x) + std::abs(ng.y * x.y) + std::abs(ng.z * x.z));
}

/// The origin of a ray along `w`: `x` moved by `offset` along `ng`, to the side of `w`.
inline V3f offset_origin(const V3f& x, const V3f& ng, float offset, const V3f& w) {
  return x + ng * std::copysign(offset, dot(w, ng));
}

/// The end of a segment of length `distance` that arrives at `x`; `w` points back along it.
inline V3f offset_end(const V3f& x, const V3f& ng, float offset, const V3f& w, float distance) {
  constexpr float few_roundings = 0x1p-21F;
  return offset_origin(x, ng, offset + few_roundings * distance, w);
}

}  // namespace lacuna
