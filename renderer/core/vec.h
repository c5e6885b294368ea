#pragma once

#include <Imath/ImathColor.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>

namespace lacuna {

using Imath::M44d;
using Imath::V2d;
using Imath::V2f;
using Imath::V2i;
using Imath::V3d;
using Imath::V3f;
using Imath::V4f;

/// Linear RGB: radiance, reflectance or a throughput. Component-wise arithmetic.
using Rgb = Imath::Color3f;

inline float dot(const V3f& a, const V3f& b) { return a.dot(b); }
inline V3f cross(const V3f& a, const V3f& b) { return a.cross(b); }
inline float abs_dot(const V3f& a, const V3f& b) { return std::abs(a.dot(b)); }

inline bool is_black(const Rgb& c) { return c.x == 0.0F && c.y == 0.0F && c.z == 0.0F; }
inline bool is_finite(const V3f& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline float max_component(const V3f& v) { return std::max(v.x, std::max(v.y, v.z)); }
inline float max_abs_component(const V3f& v) {
  return std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
}
/// Rec. 709 luminance; selection probabilities are computed from it.
template <class T>
T luminance(const T& r, const T& g, const T& b) {
  return 0.2126F * r + 0.7152F * g + 0.0722F * b;
}
inline float luminance(const Rgb& c) { return luminance(c.x, c.y, c.z); }

}  // namespace lacuna
