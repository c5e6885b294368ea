#include <gtest/gtest.h>

#include "analysis/geometry/grid.h"
#include "analysis/space/components.h"
#include "analysis/space/memory_limit.h"
#include "tests/analysis/space/soups_and_grids.h"

namespace lacuna {
namespace {

using Imath::V3i;

bool connected(V3i offset, Connectivity connectivity) {
  return connectivity == Connectivity::corners || offset.dot(offset) == 1;
}

/// Labels by flooding, in the order of first voxels.
Grid3<std::uint32_t> components_by_flood(const BitGrid3& grid, Connectivity connectivity,
                                         std::uint32_t& count) {
  Grid3<std::uint32_t> label(grid.size());
  std::fill_n(label.data(), label.count(), no_component);
  count = 0;
  for (std::size_t i = 0; i < label.count(); ++i) {
    if (!grid.get(label.voxel(i)) || label[i] != no_component) continue;
    std::vector<V3i> todo{label.voxel(i)};
    label[i] = count;
    while (!todo.empty()) {
      const V3i v = todo.back();
      todo.pop_back();
      for (int k = 0; k < 27; ++k) {
        const V3i offset(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1), w = v + offset;
        if (!connected(offset, connectivity) || !in_grid(w, grid.size()) || !grid.get(w) ||
            label(w) != no_component)
          continue;
        label(w) = count;
        todo.push_back(w);
      }
    }
    ++count;
  }
  return label;
}

void expect_as_flood(const BitGrid3& grid, Connectivity connectivity, const ThreadPool& pool) {
  std::uint32_t count = 0;
  const auto label = components_by_flood(grid, connectivity, count);
  const Components c = connected_components(grid, connectivity, pool, no_memory_limit);
  ASSERT_EQ(c.count(), count);
  std::vector<std::uint64_t> voxels(count, 0);
  std::vector<bool> border(count, false);
  for (std::size_t i = 0; i < label.count(); ++i) {
    const V3i v = label.voxel(i), last = grid.size() - V3i(1);
    ASSERT_EQ(c.at(v), label[i]) << v;
    if (label[i] == no_component) continue;
    ++voxels[label[i]];
    for (int a = 0; a < 3; ++a)
      if (v[a] == 0 || v[a] == last[a]) border[label[i]] = true;
  }
  EXPECT_EQ(c.voxels, voxels);
  EXPECT_EQ(c.touches_border, border);
}

TEST(Components, AreThoseOfAFlood) {
  for (const Connectivity connectivity : {Connectivity::faces, Connectivity::corners}) {
    for (const BitGrid3& grid : small_grids(11)) {
      expect_as_flood(grid, connectivity, one_thread());
      expect_as_flood(grid, connectivity, four_threads());
    }
    std::mt19937 rng(12);
    for (const double share : {0.08, 0.2, 0.3, 0.5})  // about where components join into one
      expect_as_flood(random_grid({70, 40, 30}, share, rng), connectivity, four_threads());
  }
}

TEST(Components, OfVoxelsThatTouchByACornerOnly) {
  BitGrid3 grid(V3i(4, 4, 4));
  grid.set(0, 0, 0);
  grid.set(1, 1, 1);
  grid.set(2, 1, 2);
  EXPECT_EQ(connected_components(grid, Connectivity::faces, one_thread(), no_memory_limit).count(),
            3u);
  EXPECT_EQ(
      connected_components(grid, Connectivity::corners, one_thread(), no_memory_limit).count(), 1u);
}

TEST(Components, AreRefusedBeforeTheyTakeTooMuchMemory) {
  BitGrid3 grid(V3i(100, 100, 100));
  for (int x = 0; x < 100; x += 2) grid.set(x, 0, 0);
  const std::uint64_t bytes = 10001 * 4 + 50 * 8;
  EXPECT_NO_THROW(connected_components(grid, Connectivity::faces, one_thread(), bytes));
  EXPECT_THROW(connected_components(grid, Connectivity::faces, one_thread(), bytes - 1),
               MemoryLimitError);
}

}  // namespace
}  // namespace lacuna
