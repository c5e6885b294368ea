#pragma once

#include <cmath>

#include "renderer/core/vec.h"

namespace lacuna {

// Rays leave a surface from a point beside it, so that they do not hit it again. The smallest safe
// distance follows from rounding errors only, not from the scene or its size. With u = 2^-24, the
// largest relative error of rounding to float:
//
// - A point x on the plane is rounded once, and the origin beside it once more. Each rounding moves
//   it across the plane by at most u sum_i |ng_i x_i|.
// - Embree's distance between an origin and the plane of a triangle has an error bounded by
//   TriangleShape::plane_error.
// - The direction of a segment, end - start, is rounded by u times its length, and Embree's
//   distance along it by a few u: both move the segment's end in proportion to its length.
//
// Each bound is doubled. The first two are 0 for a horizontal floor at height 0 of any size.

/// The distance from the surface, in scene units, at which rays from `x` start. `ng`: unit normal;
/// `plane_error`: of the triangle.
inline float ray_offset(const V3f& x, const V3f& ng, float plane_error) {
  constexpr float two_roundings = 0x1p-22F;
  return plane_error +
         two_roundings * (std::abs(ng.x * x.x) + std::abs(ng.y * x.y) + std::abs(ng.z * x.z));
}

/// The origin of a ray along `w`: `x` moved by `offset` along `ng`, towards the side of `w`.
inline V3f offset_origin(const V3f& x, const V3f& ng, float offset, const V3f& w) {
  return x + ng * std::copysign(offset, dot(w, ng));
}

/// The end of a segment of length `distance` to `x`; `w` points back along it.
inline V3f offset_end(const V3f& x, const V3f& ng, float offset, const V3f& w, float distance) {
  constexpr float few_roundings = 0x1p-21F;
  return offset_origin(x, ng, offset + few_roundings * distance, w);
}

}  // namespace lacuna
