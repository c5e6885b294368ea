#include "analysis/regions/portals.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "analysis/regions/region_faces.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/sweep.h"

namespace lacuna {

namespace {

/// A face between two regions during sorting, as a face of the lower one.
struct Found {
  std::uint32_t a, b, voxel;
  std::uint8_t side;
};

/// Calls visit(Found) for each face of plane z that leaves the lower of two regions.
template <class Visit>
void for_each_portal_face(const Grid3<std::uint32_t>& label, int z, Visit&& visit) {
  RegionFaces(label).for_each(z, [&](VoxelFace face, std::uint32_t region, std::uint32_t beyond) {
    if (beyond != no_region && region < beyond) visit(Found{region, beyond, face.voxel, face.side});
  });
}

/// All faces, ordered by a, b, side and voxel.
std::vector<Found> sorted_faces(const RegionLabels& labels, const ThreadPool& pool,
                                std::uint64_t byte_limit) {
  const Imath::V3i size = labels.label.size();
  std::vector<std::uint64_t> first(static_cast<std::size_t>(size.z) + 1, 0);
  run_parallel(pool, size.z, [&](int z) {
    std::uint64_t n = 0;
    for_each_portal_face(labels.label, z, [&](const Found&) { ++n; });
    first[static_cast<std::size_t>(z) + 1] = n;
  });
  std::partial_sum(first.begin(), first.end(), first.begin());
  const std::uint64_t total = first.back();
  require_memory("portals", size,
                 total * (2 * sizeof(Found) + sizeof(std::uint32_t)) +
                     labels.regions.size() * 2 * sizeof(std::uint64_t),
                 byte_limit);
  std::vector<Found> by_plane(total), faces(total);
  run_parallel(pool, size.z, [&](int z) {
    std::uint64_t at = first[static_cast<std::size_t>(z)];
    for_each_portal_face(labels.label, z, [&](const Found& f) { by_plane[at++] = f; });
  });
  // By region first, in linear time; the faces of one region are few.
  std::vector<std::uint64_t> of_region(labels.regions.size() + 1, 0);
  for (const Found& f : by_plane) ++of_region[f.a + std::size_t{1}];
  std::partial_sum(of_region.begin(), of_region.end(), of_region.begin());
  std::vector<std::uint64_t> next = of_region;
  for (const Found& f : by_plane) faces[next[f.a]++] = f;
  run_parallel(pool, static_cast<int>(labels.regions.size()), [&](int r) {
    const auto begin =
        faces.begin() + static_cast<std::ptrdiff_t>(of_region[static_cast<std::size_t>(r)]);
    const auto end =
        faces.begin() + static_cast<std::ptrdiff_t>(of_region[static_cast<std::size_t>(r) + 1]);
    std::sort(begin, end, [](const Found& p, const Found& q) {
      return std::tie(p.b, p.side, p.voxel) < std::tie(q.b, q.side, q.voxel);
    });
  });
  return faces;
}

}  // namespace

std::uint64_t Portal::faces() const {
  return std::accumulate(by_side.begin(), by_side.end(), std::uint64_t{0});
}

VoxelFace Portals::face(const Portal& portal, std::uint64_t i) const {
  const std::uint32_t voxel = voxels[portal.first + i];
  std::uint8_t side = 0;
  for (; i >= portal.by_side[side]; ++side) i -= portal.by_side[side];
  return {voxel, side};
}

Portals find_portals(const RegionLabels& labels, const ThreadPool& pool, std::uint64_t byte_limit) {
  Portals result;
  const std::size_t regions = labels.regions.size();
  result.first.assign(regions + 1, 0);
  if (regions == 0) return result;
  const std::vector<Found> faces = sorted_faces(labels, pool, byte_limit);
  result.voxels.reserve(faces.size());
  for (const Found& f : faces) {
    if (result.portals.empty() || result.portals.back().a != f.a || result.portals.back().b != f.b)
      result.portals.push_back({.a = f.a, .b = f.b, .first = result.voxels.size()});
    ++result.portals.back().by_side[f.side];
    result.voxels.push_back(f.voxel);
  }
  for (const Portal& p : result.portals)
    for (const std::uint32_t r : {p.a, p.b}) ++result.first[r + std::size_t{1}];
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.of_region.resize(2 * result.portals.size());
  std::vector<std::uint32_t> next = result.first;
  for (std::size_t p = 0; p < result.portals.size(); ++p)
    for (const std::uint32_t r : {result.portals[p].a, result.portals[p].b})
      result.of_region[next[r]++] = static_cast<std::uint32_t>(p);
  return result;
}

}  // namespace lacuna
