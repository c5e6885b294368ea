#include <algorithm>

#include "analysis/space/distance.h"
#include "analysis/space/line_distance.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/squared_lines.h"
#include "analysis/space/sweep.h"

namespace lacuna {

namespace {

/// The parallel lines through the voxels of a row.
struct RowOfLines {
  std::size_t first;   // index of the row
  std::size_t stride;  // between the voxels of a line
  int width, length;   // of the row, and of the lines
};

void pass_over(Grid3<std::uint32_t>& map, SquaredLines& lines, const RowOfLines& row) {
  const auto [first, stride, width, length] = row;
  for (int x = 0; x < width; x += SquaredLines::lanes) {
    const int n = std::min(SquaredLines::lanes, width - x);
    std::uint32_t* const begin = map.data() + first + x;
    for (int i = 0; i < length; ++i) {
      std::uint32_t* to = lines.at(i);
      const std::uint32_t* from = begin + static_cast<std::size_t>(i) * stride;
      std::fill(std::copy(from, from + n, to), to + SquaredLines::lanes, 0);
    }
    lines.run();
    for (int i = 0; i < length; ++i)
      std::copy(lines.at(i), lines.at(i) + n, begin + static_cast<std::size_t>(i) * stride);
  }
}

void squared_plane_distance(const BitGrid3& domain, Grid3<std::uint32_t>& map, int z) {
  const Imath::V3i size = map.size();
  LineDistance line(size.x);
  std::vector<std::uint16_t> distance(static_cast<std::size_t>(size.x));
  for (int y = 0; y < size.y; ++y) {
    line(domain, y, z, distance.data());
    std::transform(distance.begin(), distance.end(), map.row(y, z),
                   [](std::uint32_t d) { return d * d; });
  }
  SquaredLines lines(size.y);
  pass_over(map, lines, {map.index(0, 0, z), static_cast<std::size_t>(size.x), size.x, size.y});
}

}  // namespace

Grid3<std::uint32_t> squared_distance(const BitGrid3& domain, const ThreadPool& pool,
                                      std::uint64_t byte_limit) {
  const Imath::V3i size = domain.size();
  const std::uint64_t voxels = checked_voxels(size);
  require_memory("a map of squared distances", size, voxels * sizeof(std::uint32_t), byte_limit);
  Grid3<std::uint32_t> map(size);
  if (voxels == 0) return map;
  run_parallel(pool, size.z, [&](int z) { squared_plane_distance(domain, map, z); });
  const std::size_t plane = map.count() / static_cast<std::size_t>(size.z);
  run_parallel(pool, size.y, [&](int y) {
    SquaredLines lines(size.z);
    pass_over(map, lines, {map.index(0, y, 0), plane, size.x, size.z});
  });
  return map;
}

}  // namespace lacuna
