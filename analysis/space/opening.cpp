#include "analysis/space/opening.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "analysis/space/line_dilation.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/sweep.h"

// Alg. 6 of Noel 2015 (its line 8 should read [1 ... h]). One pass an axis gives definition 10.4
// exactly: where a ball loses a position to a larger one, the larger one covers it there along the
// following axes; and a ball that a scan propagates from a reached position stays within its own
// extent. Balls are cubes of empty voxels, so none passes a scene voxel.

namespace lacuna {

namespace {

/// Dilates up to `lanes` neighbouring lines across x, by copying them side by side and back.
class LinesAcross {
 public:
  static constexpr int lanes = 32;

  explicit LinesAcross(int length)
      : length_(length),
        pitch_(static_cast<std::size_t>(length) +
               24),  // not a power of two, which would share cache sets
        radius_(pitch_ * lanes),
        centre_(pitch_ * lanes),
        dilate_(length) {}

  /// The lines through the `count` voxels from `first` on, `stride` apart along each line.
  void operator()(OpeningForest& forest, std::size_t first, std::size_t stride, int count) {
    const auto n = static_cast<std::size_t>(count);
    for (std::size_t i = 0; i < static_cast<std::size_t>(length_); ++i)
      for (std::size_t lane = 0; lane < n; ++lane) {
        radius_[lane * pitch_ + i] = forest.opening[first + i * stride + lane];
        centre_[lane * pitch_ + i] = forest.centre[first + i * stride + lane];
      }
    for (std::size_t lane = 0; lane < n; ++lane)
      dilate_(&radius_[lane * pitch_], &centre_[lane * pitch_], length_);
    for (std::size_t i = 0; i < static_cast<std::size_t>(length_); ++i)
      for (std::size_t lane = 0; lane < n; ++lane) {
        forest.opening[first + i * stride + lane] = radius_[lane * pitch_ + i];
        forest.centre[first + i * stride + lane] = centre_[lane * pitch_ + i];
      }
  }

 private:
  int length_;
  std::size_t pitch_;
  std::vector<std::uint16_t> radius_;
  std::vector<std::uint32_t> centre_;
  LineDilation dilate_;
};

/// Sets every voxel to its own ball, then dilates the lines along x and y.
void dilate_plane(OpeningForest& forest, const Grid3<std::uint16_t>& chebyshev, int z) {
  const Imath::V3i size = chebyshev.size();
  const auto width = static_cast<std::size_t>(size.x);
  LineDilation along_x(size.x);
  for (int y = 0; y < size.y; ++y) {
    const std::uint16_t* distance = chebyshev.row(y, z);
    std::uint16_t* radius = forest.opening.row(y, z);
    std::uint32_t* centre = forest.centre.row(y, z);
    const auto row = static_cast<std::uint32_t>(chebyshev.index(0, y, z));
    for (std::size_t x = 0; x < width; ++x) {
      radius[x] = distance[x];
      centre[x] = distance[x] == 0 ? no_voxel : row + static_cast<std::uint32_t>(x);
    }
    along_x(radius, centre, size.x);
  }
  LinesAcross along_y(size.y);
  for (int x = 0; x < size.x; x += LinesAcross::lanes)
    along_y(forest, chebyshev.index(x, 0, z), width, std::min(LinesAcross::lanes, size.x - x));
}

}  // namespace

OpeningForest opening_forest(const Grid3<std::uint16_t>& chebyshev, const ThreadPool& pool,
                             std::uint64_t byte_limit) {
  const Imath::V3i size = chebyshev.size();
  const std::uint64_t voxels = checked_voxels(size);
  require_memory("the opening forest", size,
                 voxels * (sizeof(std::uint16_t) + sizeof(std::uint32_t)), byte_limit);
  if (voxels >= no_voxel)
    throw std::invalid_argument(
        fmt::format("the opening forest of {} voxels: up to {} are allowed", voxels, no_voxel - 1));
  OpeningForest forest{Grid3<std::uint16_t>(size), Grid3<std::uint32_t>(size)};
  if (voxels == 0) return forest;
  run_parallel(pool, size.z, [&](int z) { dilate_plane(forest, chebyshev, z); });
  const std::size_t plane = chebyshev.count() / static_cast<std::size_t>(size.z);
  run_parallel(pool, size.y, [&](int y) {
    LinesAcross along_z(size.z);
    for (int x = 0; x < size.x; x += LinesAcross::lanes)
      along_z(forest, chebyshev.index(x, y, 0), plane, std::min(LinesAcross::lanes, size.x - x));
  });
  return forest;
}

}  // namespace lacuna
