#include "analysis/regions/borders.h"

#include <algorithm>
#include <atomic>

#include "analysis/regions/region_faces.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/sweep.h"

namespace lacuna {

namespace {

/// Calls visit(6 * region + side, voxel) for each face of the border in plane z.
template <class Visit>
void for_each_border_face(const Grid3<std::uint32_t>& label, BorderFaces which, int z,
                          Visit&& visit) {
  RegionFaces(label).for_each(z, [&](VoxelFace face, std::uint32_t region, std::uint32_t beyond) {
    if (beyond != no_region || which == BorderFaces::all)
      visit(6 * std::size_t{region} + face.side, face.voxel);
  });
}

std::uint64_t add_one(std::uint64_t& counter) {
  return std::atomic_ref<std::uint64_t>(counter).fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

VoxelFace Borders::face(std::uint32_t region, std::uint64_t i) const {
  const auto begin = first.begin() + static_cast<std::ptrdiff_t>(6 * std::size_t{region});
  const std::uint64_t at = *begin + i;
  const auto after = std::upper_bound(begin, begin + 6, at);
  return {voxels[at], static_cast<std::uint8_t>(after - begin - 1)};
}

Borders find_borders(const RegionLabels& labels, BorderFaces which, const ThreadPool& pool,
                     std::uint64_t byte_limit) {
  const Imath::V3i size = labels.label.size();
  const std::size_t groups = 6 * labels.regions.size();
  require_memory("opening borders", size, 2 * groups * sizeof(std::uint64_t), byte_limit);
  Borders borders;
  borders.first.assign(groups + 1, 0);
  if (groups == 0) return borders;
  std::vector<std::uint64_t> next(groups, 0);
  run_parallel(pool, size.z, [&](int z) {
    for_each_border_face(labels.label, which, z,
                         [&](std::size_t group, std::uint32_t) { add_one(next[group]); });
  });
  for (std::size_t g = 0; g < groups; ++g) {
    borders.first[g + 1] = borders.first[g] + next[g];
    next[g] = borders.first[g];
  }
  require_memory("opening borders", size,
                 2 * groups * sizeof(std::uint64_t) + borders.first.back() * sizeof(std::uint32_t),
                 byte_limit);
  borders.voxels.resize(borders.first.back());
  run_parallel(pool, size.z, [&](int z) {
    for_each_border_face(labels.label, which, z, [&](std::size_t group, std::uint32_t voxel) {
      borders.voxels[add_one(next[group])] = voxel;
    });
  });
  // Threads append in any order; sorting makes the result deterministic.
  run_parallel(pool, static_cast<int>(labels.regions.size()), [&](int r) {
    for (std::size_t g = 6 * static_cast<std::size_t>(r); g < 6 * static_cast<std::size_t>(r) + 6;
         ++g)
      std::sort(borders.voxels.begin() + static_cast<std::ptrdiff_t>(borders.first[g]),
                borders.voxels.begin() + static_cast<std::ptrdiff_t>(borders.first[g + 1]));
  });
  return borders;
}

}  // namespace lacuna
