#include "analysis/space/components.h"

#include <algorithm>

#include "analysis/geometry/disjoint_sets.h"
#include "analysis/space/bit_rows.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/sweep.h"

namespace lacuna {

namespace {

/// Union-find over runs, by their index: while it is built, `component` is the index of a run of
/// the same component that comes no later.
struct Linker {
  Components& c;
  Connectivity connectivity;

  /// Joins the runs of two rows that touch; `slack` 1: also by a corner.
  void join_rows(std::size_t row_a, std::size_t row_b, int slack) {
    const auto link = [this](std::uint32_t i) -> std::uint32_t& { return c.runs[i].component; };
    std::uint32_t a = c.first[row_a], b = c.first[row_b];
    const std::uint32_t a_end = c.first[row_a + 1], b_end = c.first[row_b + 1];
    while (a < a_end && b < b_end) {
      const ComponentRun &p = c.runs[a], &q = c.runs[b];
      if (p.x0 < q.x1 + slack && q.x0 < p.x1 + slack) join_sets(a, b, link);
      // Runs of a row do not touch, so the one that ends first meets nothing further on.
      if (p.x1 <= q.x1)
        ++a;
      else
        ++b;
    }
  }

  void join_plane(int z) {
    const int slack = connectivity == Connectivity::corners ? 1 : 0;
    for (int y = 1; y < c.size.y; ++y) join_rows(c.row(y - 1, z), c.row(y, z), slack);
  }

  void join_planes(int z) {  // z - 1 and z
    const int reach = connectivity == Connectivity::corners ? 1 : 0;
    for (int y = 0; y < c.size.y; ++y)
      for (int from = std::max(0, y - reach); from <= std::min(c.size.y - 1, y + reach); ++from)
        join_rows(c.row(from, z - 1), c.row(y, z), reach);
  }
};

/// Counts the runs of each row and makes offsets of the counts.
void count_runs(const BitGrid3& grid, Components& c, const ThreadPool& pool,
                std::uint64_t byte_limit) {
  const auto rows = static_cast<std::size_t>(c.size.y) * static_cast<std::size_t>(c.size.z);
  require_memory("components", c.size, (rows + 1) * sizeof(std::uint32_t), byte_limit);
  c.first.assign(rows + 1, 0);
  run_parallel(pool, c.size.z, [&](int z) {
    BitRow row(c.size.x);
    for (int y = 0; y < c.size.y; ++y) {
      row.read(grid, y, z);
      row.for_each_run([&](int, int) { ++c.first[c.row(y, z) + 1]; });
    }
  });
  std::uint64_t runs = 0;
  for (std::uint32_t& offset : c.first) {
    runs += offset;
    offset = static_cast<std::uint32_t>(std::min<std::uint64_t>(runs, no_component));
  }
  if (runs >= no_component) throw MemoryLimitError("components: more than 2^32 - 2 runs of voxels");
  require_memory("components", c.size,
                 (rows + 1) * sizeof(std::uint32_t) + runs * sizeof(ComponentRun), byte_limit);
  c.runs.resize(runs);
}

/// Every run becomes its own root.
void fill_runs(const BitGrid3& grid, Components& c, const ThreadPool& pool) {
  run_parallel(pool, c.size.z, [&](int z) {
    BitRow row(c.size.x);
    for (int y = 0; y < c.size.y; ++y) {
      row.read(grid, y, z);
      std::uint32_t i = c.first[c.row(y, z)];
      row.for_each_run([&](int x0, int x1) {
        c.runs[i] = {static_cast<std::uint16_t>(x0), static_cast<std::uint16_t>(x1), i};
        ++i;
      });
    }
  });
}

/// Slabs of planes each by itself, then what joins them.
void join_all(Components& c, Connectivity connectivity, const ThreadPool& pool) {
  Linker linker{c, connectivity};
  const int slabs = std::min(c.size.z, pool.threads() == 1 ? 1 : 4 * pool.threads());
  const auto cut = [&](int s) { return static_cast<int>(std::int64_t{c.size.z} * s / slabs); };
  run_parallel(pool, slabs, [&](int s) {
    for (int z = cut(s); z < cut(s + 1); ++z) {
      linker.join_plane(z);
      if (z > cut(s)) linker.join_planes(z);
    }
  });
  for (int s = 1; s < slabs; ++s) linker.join_planes(cut(s));
}

/// From roots to numbers. A root comes before the runs that lead to it.
void number_components(Components& c) {
  const int last_y = c.size.y - 1, last_z = c.size.z - 1;
  for (int z = 0; z <= last_z; ++z)
    for (int y = 0; y <= last_y; ++y)
      for (std::uint32_t i = c.first[c.row(y, z)]; i < c.first[c.row(y, z) + 1]; ++i) {
        ComponentRun& run = c.runs[i];
        if (run.component == i) {
          run.component = static_cast<std::uint32_t>(c.voxels.size());
          c.voxels.push_back(0);
          c.touches_border.push_back(false);
        } else {
          run.component = c.runs[run.component].component;  // which has its number already
        }
        c.voxels[run.component] += static_cast<std::uint64_t>(run.x1 - run.x0);
        if (y == 0 || z == 0 || y == last_y || z == last_z || run.x0 == 0 || run.x1 == c.size.x)
          c.touches_border[run.component] = true;
      }
}

}  // namespace

std::uint32_t Components::at(Imath::V3i v) const {
  const auto begin = runs.begin() + first[row(v.y, v.z)],
             end = runs.begin() + first[row(v.y, v.z) + 1];
  const auto after =
      std::upper_bound(begin, end, v.x, [](int x, const ComponentRun& run) { return x < run.x0; });
  if (after == begin || v.x >= (after - 1)->x1) return no_component;
  return (after - 1)->component;
}

Components connected_components(const BitGrid3& grid, Connectivity connectivity,
                                const ThreadPool& pool, std::uint64_t byte_limit) {
  Components c;
  c.size = grid.size();
  if (checked_voxels(c.size) == 0) {
    c.first.assign(1, 0);
    return c;
  }
  count_runs(grid, c, pool, byte_limit);
  fill_runs(grid, c, pool);
  join_all(c, connectivity, pool);
  number_components(c);
  return c;
}

}  // namespace lacuna
