#pragma once

#include <array>
#include <cmath>
#include <numeric>

#include "renderer/core/vec.h"

namespace lacuna::gltf {

/// Row `i` in [0, 3] of a transform without its last column.
inline V3d row(const M44d& m, int i) { return {m[i][0], m[i][1], m[i][2]}; }

inline double determinant3(const M44d& m) { return row(m, 0).dot(row(m, 1).cross(row(m, 2))); }

/// Finite, with axes whose lengths are, too.
inline bool all_finite(const M44d& m) {
  for (int i = 0; i < 4; ++i) {
    if (!std::isfinite(row(m, i).length())) return false;
  }
  return true;
}

/// A node's transform, in that order; the quaternion's length does not count.
inline M44d transform_of(const std::array<double, 3>& scale, std::array<double, 4> rotation,
                         const std::array<double, 3>& translation) {
  const double norm =
      std::sqrt(std::inner_product(rotation.begin(), rotation.end(), rotation.begin(), 0.0));
  for (double& component : rotation) component /= norm;
  const auto [x, y, z, w] = rotation;
  const V3d axes[3] = {
      {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
      {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
      {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)},
  };
  M44d m;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    for (int j = 0; j < 3; ++j) m[i][j] = scale[axis] * axes[i][j];
    m[3][i] = translation[axis];
  }
  return m;
}

/// The unit direction of `a`, of any length; 0 if it has none.
inline V3d direction(const V3d& a) {
  const double largest = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
  return largest > 0 ? (a / largest).normalized() : V3d(0.0);
}

/// Dimensions that a transform leaves of space: 3 where it can be inverted; 2 where it flattens
/// meshes; 0 where it leaves a line or a point. By the directions of the axes, so that a scale of
/// 1e-8 along one of them is fine.
inline int rank_of(const M44d& m) {
  constexpr double cancelled = 1e-12;  // rounding error of 0 in products of matrices
  const V3d axes[3] = {direction(row(m, 0)), direction(row(m, 1)), direction(row(m, 2))};
  if (std::abs(axes[0].cross(axes[1]).dot(axes[2])) > cancelled) return 3;
  for (int i = 0; i < 3; ++i) {
    if (axes[i].cross(axes[(i + 1) % 3]).length() > cancelled) return 2;
  }
  return 0;
}

/// glTF stores columns for column vectors, which is what Imath stores as rows for row vectors. The
/// fourth row, 0 0 0 1 but for rounding, is not read.
template <class T>
M44d matrix_of(const std::array<T, 16>& a) {
  M44d m;
  for (std::size_t i = 0; i < 16; ++i) {
    if (i % 4 < 3) m[static_cast<int>(i / 4)][i % 4] = static_cast<double>(a[i]);
  }
  return m;
}

}  // namespace lacuna::gltf
