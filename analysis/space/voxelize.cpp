#include "analysis/space/voxelize.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "analysis/settings/analysis_settings.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/sweep.h"
#include "analysis/space/triangle_box.h"

// Triangles are first sorted into tiles of voxels, a large one into each tile that it intersects;
// then each thread fills one tile at a time, which no other thread writes. A scene of many
// instances is taken in batches, so that the lists stay small.

namespace lacuna {

namespace {

constexpr int tile_side = 32;  // voxels: whole blocks of a BitGrid3
static_assert(tile_side % BitBlock::side == 0);
constexpr int max_chunks = 32;                               // of triangles, for sorting
constexpr std::uint64_t max_batch = std::uint64_t{1} << 24;  // triangles: lists of some 128 MiB

/// Pool threads treat denormal floats as 0; a voxel must be far larger.
constexpr double least_extent = 1e-25;

Imath::V3i tiles_of(Imath::V3i size) { return (size + Imath::V3i(tile_side - 1)) / tile_side; }

std::uint64_t volume(Imath::V3i size) {
  return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) *
         static_cast<std::uint64_t>(size.z);
}

std::uint64_t grid_bytes(Imath::V3i size) {
  return volume((size + Imath::V3i(BitBlock::side - 1)) / BitBlock::side) * sizeof(BitBlock);
}

/// The lists of triangles by tile, with `references` entries.
std::uint64_t list_bytes(Imath::V3i size, std::uint64_t references) {
  return volume(tiles_of(size)) * (max_chunks + 1) * sizeof(std::uint64_t) +
         references * sizeof(std::uint32_t);
}

struct Bounds {
  Imath::V3d low{std::numeric_limits<double>::infinity()};
  Imath::V3d high{-std::numeric_limits<double>::infinity()};
};

Bounds bounds_of(const TriangleSoup& soup) {
  Bounds b;
  const auto add = [&b](const Imath::V3d& p, std::size_t i) {
    for (int a = 0; a < 3; ++a) {
      if (!std::isfinite(p[a]))
        throw GeometryError(
            fmt::format("position {} has coordinate {}: it must be finite", i, p[a]));
      b.low[a] = std::min(b.low[a], p[a]);
      b.high[a] = std::max(b.high[a], p[a]);
    }
  };
  for (const auto& t : soup.triangles)
    for (const std::uint32_t i : t) add(Imath::V3d(soup.positions[i]), i);
  for (const auto& placement : soup.placements) {
    const auto& positions = soup.prototypes[placement.prototype].positions;
    for (std::size_t i = 0; i < positions.size(); ++i) add(placement.point(positions[i]), i);
  }
  return b;
}

/// Triangles by tile: tile i has triangles list[first[i]] to list[first[i + 1]].
struct TileLists {
  std::vector<std::uint64_t> first;
  std::vector<std::uint32_t> list;
};

/// Fills in a batch of triangles, [begin, end) of the soup.
class Voxelizer {
 public:
  Voxelizer(const TriangleSoup& soup, const GridPlan& plan, const ThreadPool& pool,
            std::uint64_t begin, std::uint64_t end)
      : soup_(soup),
        plan_(plan),
        pool_(pool),
        tiles_(tiles_of(plan.size)),
        begin_(begin),
        count_(end - begin) {
    chunks_ = static_cast<int>(std::min<std::uint64_t>({count_, max_chunks, 4u * pool.threads()}));
  }

  TileLists sort_into_tiles(std::uint64_t byte_limit) const;
  void fill_tile(const TileLists& lists, int tile, BitGrid3& scene) const;
  int tile_count() const { return tiles_.x * tiles_.y * tiles_.z; }
  std::size_t tile_index(Imath::V3i t) const {
    const int index = (t.z * tiles_.y + t.y) * tiles_.x + t.x;  // below tile_count()
    return static_cast<std::size_t>(index);
  }

 private:
  std::array<Imath::V3d, 3> corners(std::uint64_t of_batch, double cell) const {
    std::array<Imath::V3d, 3> c = soup_.corners(begin_ + of_batch);
    for (Imath::V3d& corner : c) corner = plan_.transform.to_grid(corner) / cell;
    return c;
  }
  template <class Visit>
  void for_each_tile(int chunk, Visit&& visit) const;

  const TriangleSoup& soup_;
  const GridPlan& plan_;
  const ThreadPool& pool_;
  Imath::V3i tiles_;
  std::uint64_t begin_, count_;
  int chunks_;
};

/// Calls visit(tile, triangle) for the triangles of a chunk and the tiles that each intersects.
template <class Visit>
void Voxelizer::for_each_tile(int chunk, Visit&& visit) const {
  const auto chunks = static_cast<std::uint64_t>(chunks_);
  const std::uint64_t begin = count_ * static_cast<std::uint64_t>(chunk) / chunks,
                      end = count_ * (static_cast<std::uint64_t>(chunk) + 1) / chunks;
  for (std::uint64_t t = begin; t < end; ++t)
    TriangleBox(corners(t, tile_side))
        .for_each_line({Imath::V3i(0), tiles_}, [&](int axis, Imath::V3i tile, int length) {
          for (; length > 0; --length, ++tile[axis])
            visit(tile_index(tile), static_cast<std::uint32_t>(t));
        });
}

TileLists Voxelizer::sort_into_tiles(std::uint64_t byte_limit) const {
  const auto tiles = static_cast<std::size_t>(tile_count());
  // By chunk and tile: first the number of triangles, then the chunk's offset in the tile's list.
  std::vector<std::vector<std::uint64_t>> next(static_cast<std::size_t>(chunks_));
  run_parallel(pool_, chunks_, [&](int c) {
    auto& counts = next[static_cast<std::size_t>(c)];
    counts.assign(tiles, 0);
    for_each_tile(c, [&](std::size_t tile, std::uint32_t) { ++counts[tile]; });
  });
  TileLists lists;
  lists.first.reserve(tiles + 1);
  std::uint64_t total = 0;
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    lists.first.push_back(total);
    for (auto& of_chunk : next) {
      const std::uint64_t count = of_chunk[tile];
      of_chunk[tile] = total;
      total += count;
    }
  }
  lists.first.push_back(total);
  require_memory("voxelising", plan_.size, grid_bytes(plan_.size) + list_bytes(plan_.size, total),
                 byte_limit);
  lists.list.resize(total);
  run_parallel(pool_, chunks_, [&](int c) {
    auto& at = next[static_cast<std::size_t>(c)];
    for_each_tile(
        c, [&](std::size_t tile, std::uint32_t triangle) { lists.list[at[tile]++] = triangle; });
  });
  return lists;
}

void Voxelizer::fill_tile(const TileLists& lists, int tile, BitGrid3& scene) const {
  CellBox clip;
  clip.low = Imath::V3i(tile % tiles_.x, tile / tiles_.x % tiles_.y, tile / tiles_.x / tiles_.y) *
             tile_side;
  for (int a = 0; a < 3; ++a) clip.high[a] = std::min(clip.low[a] + tile_side, plan_.size[a]);
  const auto i = static_cast<std::size_t>(tile);
  for (std::uint64_t k = lists.first[i]; k < lists.first[i + 1]; ++k)
    TriangleBox(corners(lists.list[k], 1))
        .for_each_line(clip, [&](int axis, Imath::V3i voxel, int length) {
          for (; length > 0; --length, ++voxel[axis]) scene.set(voxel);
        });
}

}  // namespace

GridPlan plan_grid(const TriangleSoup& soup, int resolution) {
  if (resolution < 1 || resolution > max_resolution)
    throw std::invalid_argument(
        fmt::format("resolution {}: 1 to {} are allowed", resolution, max_resolution));
  if (soup.size() == 0) throw GeometryError("the scene has no triangles, so it has no grid");
  const Bounds bounds = bounds_of(soup);
  const Imath::V3d extent = bounds.high - bounds.low;
  const double longest = std::max({extent.x, extent.y, extent.z});
  GridPlan plan;
  if (longest == 0) {
    plan.size = Imath::V3i(1);
    plan.transform = {bounds.low - Imath::V3d(0.5), 1};
  } else if (longest < least_extent) {
    throw GeometryError(
        fmt::format("the scene spans {} units: at least {} are needed", longest, least_extent));
  } else {
    plan.transform = {bounds.low, longest / resolution};
    for (int a = 0; a < 3; ++a) {
      // A side that is an integer number of voxels up to rounding gets no extra voxel.
      const double voxels = std::ceil(extent[a] / plan.transform.voxel_size - 1e-10);
      plan.size[a] = std::clamp(static_cast<int>(voxels), 1, resolution);
    }
  }
  plan.bytes = grid_bytes(plan.size) + list_bytes(plan.size, 2 * std::min(soup.size(), max_batch));
  return plan;
}

Voxels voxelize(const TriangleSoup& soup, int resolution, const ThreadPool& pool,
                std::uint64_t byte_limit) {
  const GridPlan plan = plan_grid(soup, resolution);
  require_memory("voxelising", plan.size, plan.bytes, byte_limit);
  Voxels voxels{plan.transform, BitGrid3(plan.size)};
  for (std::uint64_t begin = 0; begin < soup.size(); begin += max_batch) {
    const Voxelizer voxelizer(soup, plan, pool, begin, std::min(soup.size(), begin + max_batch));
    const TileLists lists = voxelizer.sort_into_tiles(byte_limit);
    run_parallel(pool, voxelizer.tile_count(),
                 [&](int tile) { voxelizer.fill_tile(lists, tile, voxels.scene); });
  }
  return voxels;
}

}  // namespace lacuna
