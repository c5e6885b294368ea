#pragma once

#include <array>
#include <cmath>

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
