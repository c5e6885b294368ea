#include "analysis/space/components.h"

#include "analysis/space/bit_rows.h"

namespace lacuna {

namespace {

struct GridRows {
  const BitGrid3& grid;
  BitRow row;

  template <class Visit>
  void for_each_run(int y, int z, const Visit& visit) {
    row.read(grid, y, z);
    row.for_each_run(visit);
  }
  void read_links(int, int, int) const {}
  bool linked(const ComponentRun&, const ComponentRun&) const { return true; }
};

}  // namespace

Components connected_components(const BitGrid3& grid, Connectivity connectivity,
                                const ThreadPool& pool, std::uint64_t byte_limit) {
  const Imath::V3i size = grid.size(), last = size - Imath::V3i(1);
  Components c{
      label_runs(size, GridRows{grid, BitRow(size.x)}, connectivity, pool, byte_limit), {}, {}};
  c.voxels.assign(c.count(), 0);
  c.touches_border.assign(c.count(), false);
  c.for_each_run([&](const ComponentRun& run, int y, int z) {
    c.voxels[run.component] += static_cast<std::uint64_t>(run.x1 - run.x0);
    if (y == 0 || z == 0 || y == last.y || z == last.z || run.x0 == 0 || run.x1 == size.x)
      c.touches_border[run.component] = true;
  });
  return c;
}

}  // namespace lacuna
