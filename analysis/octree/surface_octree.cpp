#include "analysis/octree/surface_octree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/geometry/morton.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/triangle_box.h"

namespace lacuna {

namespace {

constexpr int chunks = 64;  // of triangles, for any number of threads

/// Calls `use(axis, first, count)` for the lines of cells that the triangles of a chunk intersect.
template <class Use>
void for_each_line(const TriangleSoup& soup, const OctreeCube& cube, int chunk, Use&& use) {
  const std::uint64_t n = soup.size();
  const auto part = [&](int c) { return n * static_cast<std::uint64_t>(c) / chunks; };
  const GridTransform cells{cube.corner, cube.side / (1 << cube.levels)};
  const CellBox all{Imath::V3i(0), Imath::V3i(1 << cube.levels)};
  for (std::uint64_t t = part(chunk); t < part(chunk + 1); ++t) {
    std::array<Imath::V3d, 3> corners = soup.corners(t);
    for (Imath::V3d& corner : corners) corner = cells.to_grid(corner);
    TriangleBox(corners).for_each_line(all, use);
  }
}

}  // namespace

OctreeCube octree_cube(const TriangleSoup& soup, double levels) {
  Imath::V3d low(std::numeric_limits<double>::infinity());
  Imath::V3d high(-std::numeric_limits<double>::infinity());
  const auto add = [&](const Imath::V3d& p) {
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a]);
    }
  };
  for (const auto& t : soup.triangles) {
    for (const std::uint32_t i : t) add(Imath::V3d(soup.positions[i]));
  }
  for (const auto& placement : soup.placements) {
    for (const auto& p : soup.prototypes[placement.prototype].positions) add(placement.point(p));
  }
  if (soup.size() == 0) low = Imath::V3d(0.0), high = Imath::V3d(1.0);
  return octree_cube(low, high, levels);
}

OctreeCube octree_cube(const Imath::V3d& low, const Imath::V3d& high, double levels) {
  const Imath::V3d size = high - low;
  double longest = std::max({size.x, size.y, size.z});
  if (!(longest > 0)) longest = 1;
  // A margin for rounding: no cell is cut off.
  OctreeCube cube;
  cube.levels = static_cast<int>(std::ceil(levels));
  cube.side = longest * (1 + 0x1p-16) * std::exp2(cube.levels - levels);
  cube.corner = (low + high) / 2 - Imath::V3d(cube.side / 2);
  return cube;
}

Octree surface_octree(const TriangleSoup& soup, double levels, const ThreadPool& pool,
                      std::uint64_t byte_limit) {
  const OctreeCube cube = octree_cube(soup, levels);
  std::array<std::uint64_t, chunks> counts{};
  pool.for_each(chunks, [&](int c) {
    for_each_line(soup, cube, c, [&](int, Imath::V3i, int count) {
      counts[static_cast<std::size_t>(c)] += static_cast<std::uint64_t>(count);
    });
  });
  std::uint64_t total = 0;
  for (const std::uint64_t n : counts) total += n;
  // The codes, twice while they are merged, and the nodes.
  const std::uint64_t bytes = total * (2 * sizeof(std::uint64_t) + 2 * sizeof(Octree::Node));
  if (bytes > byte_limit) {
    throw MemoryLimitError(
        fmt::format("an octree of {} levels would take up to {} MiB of memory; {} MiB are allowed",
                    levels, bytes >> 20, byte_limit >> 20));
  }
  std::array<std::vector<std::uint64_t>, chunks> parts;
  pool.for_each(chunks, [&](int c) {
    auto& codes = parts[static_cast<std::size_t>(c)];
    codes.reserve(counts[static_cast<std::size_t>(c)]);
    for_each_line(soup, cube, c, [&](int axis, Imath::V3i cell, int count) {
      for (; count > 0; --count, ++cell[axis]) {
        codes.push_back(morton_code(static_cast<std::uint64_t>(cell.x),
                                    static_cast<std::uint64_t>(cell.y),
                                    static_cast<std::uint64_t>(cell.z)));
      }
    });
    std::sort(codes.begin(), codes.end());
    codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  });
  std::vector<std::uint64_t> all;
  for (auto& codes : parts) {
    const auto middle = static_cast<std::ptrdiff_t>(all.size());
    all.insert(all.end(), codes.begin(), codes.end());
    codes = {};
    std::inplace_merge(all.begin(), all.begin() + middle, all.end());
  }
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return build_octree(all, cube.levels, cube.corner, cube.side);
}

}  // namespace lacuna
