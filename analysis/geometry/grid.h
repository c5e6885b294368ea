#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>

namespace lacuna {

/// A value for every voxel of a grid, x fastest, then y, then z.
template <class T>
class Grid3 {
 public:
  Grid3() = default;
  /// Values are not initialised: the caller must write all of them.
  explicit Grid3(Imath::V3i size)
      : size_(size), cells_(std::make_unique_for_overwrite<T[]>(count())) {}

  Imath::V3i size() const { return size_; }
  std::size_t count() const {
    return static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
           static_cast<std::size_t>(size_.z);
  }
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_.x) +
           static_cast<std::size_t>(x);
  }
  std::size_t index(Imath::V3i v) const { return index(v.x, v.y, v.z); }
  Imath::V3i voxel(std::size_t index) const {
    const auto w = static_cast<std::size_t>(size_.x), h = static_cast<std::size_t>(size_.y);
    return {static_cast<int>(index % w), static_cast<int>(index / w % h),
            static_cast<int>(index / (w * h))};
  }

  T& operator[](std::size_t i) { return cells_[i]; }
  const T& operator[](std::size_t i) const { return cells_[i]; }
  T& operator()(int x, int y, int z) { return cells_[index(x, y, z)]; }
  const T& operator()(int x, int y, int z) const { return cells_[index(x, y, z)]; }
  T& operator()(Imath::V3i v) { return cells_[index(v)]; }
  const T& operator()(Imath::V3i v) const { return cells_[index(v)]; }
  /// The values of one line along x.
  T* row(int y, int z) { return cells_.get() + index(0, y, z); }
  const T* row(int y, int z) const { return cells_.get() + index(0, y, z); }
  T* data() { return cells_.get(); }
  const T* data() const { return cells_.get(); }

 private:
  Imath::V3i size_{0};
  std::unique_ptr<T[]> cells_;
};

/// Whether a voxel lies in a grid of that size.
inline bool in_grid(Imath::V3i v, Imath::V3i size) {
  return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < size.x && v.y < size.y && v.z < size.z;
}

/// The voxel that contains a point in grid coordinates. Points up to half a voxel outside the grid,
/// by rounding, belong to the outermost voxels; none for points further out and NaN.
inline std::optional<Imath::V3i> voxel_at(Imath::V3d point, Imath::V3i size) {
  constexpr double rim = 0.5;
  Imath::V3i v;
  for (int a = 0; a < 3; ++a) {
    if (size[a] == 0 || !(point[a] >= -rim && point[a] <= size[a] + rim)) return {};
    v[a] = std::clamp(static_cast<int>(std::floor(point[a])), 0, size[a] - 1);
  }
  return v;
}

/// The position of a grid in the scene: voxel v spans origin + voxel_size * [v, v + 1]. Grid
/// coordinates are in voxels, in double, because scenes may lie far from the origin.
struct GridTransform {
  Imath::V3d origin{0.0};   ///< scene units
  double voxel_size = 1.0;  ///< scene units, above 0

  Imath::V3d to_grid(Imath::V3d world) const { return (world - origin) / voxel_size; }
  Imath::V3d to_world(Imath::V3d grid) const { return origin + grid * voxel_size; }
};

}  // namespace lacuna
