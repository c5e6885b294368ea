#include "analysis/space/distance.h"

#include <algorithm>

#include "analysis/space/line_distance.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/sweep.h"

// L1 and Chebyshev distances are propagated from row to row and from plane to plane, all x of a row
// at once. A shortest path can be ordered so that it moves along x first, then in its plane, then
// across planes; with the Chebyshev distance each later step may also move by one along the earlier
// axes. So one ascending and one descending pass an axis are enough.

namespace lacuna {

namespace {

using Row = std::uint16_t*;
using ConstRow = const std::uint16_t*;

/// The outside of the grid has distance 0.
void limit_to_one(Row __restrict row, int width) {
  for (int x = 0; x < width; ++x) row[x] = std::min<std::uint16_t>(row[x], 1);
}

/// row = min(row, from + 1).
void step_over_face(Row __restrict row, ConstRow __restrict from, int width) {
  for (int x = 0; x < width; ++x)
    row[x] = std::min(row[x], static_cast<std::uint16_t>(from[x] + 1));
}

/// row = min(row, 1 + min of `from` at x - 1, x, x + 1).
void step_over_corner(Row __restrict row, ConstRow __restrict from, int width) {
  row[0] = std::min<std::uint16_t>(row[0], 1);
  row[width - 1] = std::min<std::uint16_t>(row[width - 1], 1);
  for (int x = 1; x < width - 1; ++x) {
    const std::uint16_t least = std::min(std::min(from[x - 1], from[x]), from[x + 1]);
    row[x] = std::min(row[x], static_cast<std::uint16_t>(least + 1));
  }
}

/// step_over_corner() from three adjacent rows.
void step_over_corner(Row __restrict row, ConstRow __restrict a, ConstRow __restrict b,
                      ConstRow __restrict c, int width) {
  row[0] = std::min<std::uint16_t>(row[0], 1);
  row[width - 1] = std::min<std::uint16_t>(row[width - 1], 1);
  for (int x = 1; x < width - 1; ++x) {
    const std::uint16_t low = std::min(std::min(a[x - 1], b[x - 1]), c[x - 1]);
    const std::uint16_t mid = std::min(std::min(a[x], b[x]), c[x]);
    const std::uint16_t high = std::min(std::min(a[x + 1], b[x + 1]), c[x + 1]);
    const std::uint16_t least = std::min(std::min(low, mid), high);
    row[x] = std::min(row[x], static_cast<std::uint16_t>(least + 1));
  }
}

/// Distances within plane z, its rim included.
template <class StepRow>
void plane_distance(const BitGrid3& domain, Grid3<std::uint16_t>& map, int z, StepRow step_row) {
  const int width = map.size().x, height = map.size().y;
  LineDistance line(width);
  for (int y = 0; y < height; ++y) {
    line(domain, y, z, map.row(y, z));
    if (y > 0) step_row(map.row(y, z), map.row(y - 1, z), width);
    if (y == 0 || y == height - 1) limit_to_one(map.row(y, z), width);
  }
  for (int y = height - 2; y >= 0; --y) step_row(map.row(y, z), map.row(y + 1, z), width);
}

void step_face_rows(Grid3<std::uint16_t>& map, int z, int from, int y0, int y1) {
  const int width = map.size().x;
  for (int y = y0; y < y1; ++y) step_over_face(map.row(y, z), map.row(y, from), width);
}

void step_corner_rows(Grid3<std::uint16_t>& map, int z, int from, int y0, int y1) {
  const int width = map.size().x, height = map.size().y;
  // Rows at the rim are at most 1 already.
  for (int y = std::max(y0, 1); y < std::min(y1, height - 1); ++y)
    step_over_corner(map.row(y, z), map.row(y - 1, from), map.row(y, from), map.row(y + 1, from),
                     width);
}

using StepRow = void (*)(Row, ConstRow, int);
using StepPlane = void (*)(Grid3<std::uint16_t>& map, int z, int from, int y0, int y1);

/// A metric, as the steps from one row and one plane to the next.
struct Metric {
  int reach;  // rows to either side that a row of the next plane depends on
  StepRow row;
  StepPlane plane;
};

Grid3<std::uint16_t> distance_map(const BitGrid3& domain, const ThreadPool& pool,
                                  std::uint64_t byte_limit, const Metric& metric) {
  const Imath::V3i size = domain.size();
  const std::uint64_t voxels = checked_voxels(size);
  require_memory("a distance map", size, voxels * sizeof(std::uint16_t), byte_limit);
  Grid3<std::uint16_t> map(size);
  if (voxels == 0) return map;
  const auto step = [&](int z, int from, int y0, int y1) {
    if (from < 0 || from >= size.z) {
      for (int y = y0; y < y1; ++y) limit_to_one(map.row(y, z), size.x);
    } else {
      metric.plane(map, z, from, y0, y1);
    }
  };
  sweep({.size = size,
         .direction = SweepDirection::ascending,
         .reach = metric.reach,
         .prepare = [&](int z) { plane_distance(domain, map, z, metric.row); },
         .step = [&](int z, int y0, int y1) { step(z, z - 1, y0, y1); }},
        pool);
  sweep({.size = size,
         .direction = SweepDirection::descending,
         .reach = metric.reach,
         .prepare = {},
         .step = [&](int z, int y0, int y1) { step(z, z + 1, y0, y1); }},
        pool);
  return map;
}

}  // namespace

Grid3<std::uint16_t> l1_distance(const BitGrid3& domain, const ThreadPool& pool,
                                 std::uint64_t byte_limit) {
  return distance_map(domain, pool, byte_limit, {0, step_over_face, step_face_rows});
}

Grid3<std::uint16_t> chebyshev_distance(const BitGrid3& domain, const ThreadPool& pool,
                                        std::uint64_t byte_limit) {
  return distance_map(domain, pool, byte_limit, {1, step_over_corner, step_corner_rows});
}

}  // namespace lacuna
