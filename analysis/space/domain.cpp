#include "analysis/space/domain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/geometry/shell.h"
#include "analysis/space/bit_rows.h"
#include "analysis/space/components.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/sweep.h"

namespace lacuna {

namespace {

class Selection {
 public:
  explicit Selection(const Components& components)
      : components_(components), kept_(components.count(), false) {}

  bool kept(std::uint32_t component) const { return kept_[component]; }
  void keep(Imath::V3i voxel) { kept_[components_.at(voxel)] = true; }
  void keep_border() {
    if (border_kept_) return;
    border_kept_ = true;
    for (std::size_t c = 0; c < kept_.size(); ++c)
      if (components_.touches_border[c]) kept_[c] = true;
  }
  /// False if the seed selects nothing.
  bool keep_for(const Seed& seed, const GridTransform& transform);

 private:
  bool empty(Imath::V3i v) const { return components_.at(v) != no_component; }
  bool keep_from_shell(Imath::V3i s, int radius);
  bool keep_from_shell(Imath::V3i s, int radius, Imath::V3d normal);

  const Components& components_;
  std::vector<bool> kept_;
  bool border_kept_ = false;
};

bool Selection::keep_from_shell(Imath::V3i s, int radius) {
  bool found = false;
  for_each_in_shell(radius, [&](Imath::V3i offset) {
    const Imath::V3i v = s + offset;
    if (!in_grid(v, components_.size)) {
      keep_border();
      found = true;
    } else if (empty(v)) {
      keep(v);
      found = true;
    }
  });
  return found;
}

bool Selection::keep_from_shell(Imath::V3i s, int radius, Imath::V3d normal) {
  BestAlongNormal inside, outside;
  for_each_in_shell(radius, [&](Imath::V3i offset) {
    const double product = Imath::V3d(offset).dot(normal);
    const Imath::V3i v = s + offset;
    if (!in_grid(v, components_.size)) {
      if (outside.beaten_by(product, offset)) outside.take(product, offset, v);
    } else if (inside.beaten_by(product, offset) && empty(v)) {
      inside.take(product, offset, v);
    }
  });
  if (inside.found()) keep(inside.voxel);
  if (outside.found() && outside.product > inside.product) keep_border();
  return inside.found() || outside.found();
}

bool Selection::keep_for(const Seed& seed, const GridTransform& transform) {
  const std::optional<Imath::V3i> s = voxel_at(transform.to_grid(seed.position), components_.size);
  if (!s) {
    keep_border();
    return true;
  }
  if (empty(*s)) {
    keep(*s);
    return true;
  }
  for (int radius = 1; radius <= seed_reach; ++radius)
    if (seed.normal ? keep_from_shell(*s, radius, *seed.normal) : keep_from_shell(*s, radius))
      return true;
  return false;
}

void check(const Seed& seed, std::size_t i) {
  const auto finite = [](Imath::V3d v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  const Imath::V3d& p = seed.position;
  if (!finite(p))
    throw std::invalid_argument(
        fmt::format("seed {}: position ({}, {}, {}) is not finite", i, p.x, p.y, p.z));
  if (!seed.normal) return;
  const Imath::V3d& n = *seed.normal;
  if (!finite(n) || n == Imath::V3d(0.0))
    throw std::invalid_argument(
        fmt::format("seed {}: normal ({}, {}, {}) must be finite and not 0", i, n.x, n.y, n.z));
}

/// Clears the runs of components that are not kept.
void drop(BitGrid3& grid, const Components& c, const Selection& selection, const ThreadPool& pool) {
  run_parallel(pool, grid.blocks().z, [&](int bz) {  // threads share no block
    for (int z = 8 * bz; z < std::min(8 * bz + 8, c.size.z); ++z)
      for (int y = 0; y < c.size.y; ++y)
        for (std::uint32_t i = c.first[c.row(y, z)]; i < c.first[c.row(y, z) + 1]; ++i)
          if (const ComponentRun& run = c.runs[i]; !selection.kept(run.component))
            reset_run(grid, run.x0, run.x1, y, z);
  });
}

}  // namespace

BitGrid3 empty_voxels(const BitGrid3& scene) {
  BitGrid3 empty(scene.size());
  const Imath::V3i blocks = scene.blocks(), size = scene.size();
  const auto inside = [](int n, int block) { return std::min(n - 8 * block, 8); };
  for (int bz = 0; bz < blocks.z; ++bz)
    for (int by = 0; by < blocks.y; ++by)
      for (int bx = 0; bx < blocks.x; ++bx) {
        const std::uint64_t byte = (1u << inside(size.x, bx)) - 1;
        const int rows = inside(size.y, by);
        const std::uint64_t mask =
            (byte * 0x0101010101010101u) & (~std::uint64_t{0} >> (8 * (8 - rows)));
        for (int z = 0; z < inside(size.z, bz); ++z) {
          const auto k = static_cast<std::size_t>(z);
          empty.block(bx, by, bz).z[k] = ~scene.block(bx, by, bz).z[k] & mask;
        }
      }
  return empty;
}

Domain restrict_domain(const Voxels& voxels, const DomainSeeds& seeds, const ThreadPool& pool,
                       std::uint64_t byte_limit) {
  const Imath::V3i size = voxels.scene.size();
  for (std::size_t i = 0; i < seeds.points.size(); ++i) check(seeds.points[i], i);
  const std::uint64_t grid_bytes = voxels.scene.data().size() * sizeof(BitBlock);
  require_memory("the domain", size, grid_bytes, byte_limit);

  Domain domain{.voxels = empty_voxels(voxels.scene)};
  const Components components =
      connected_components(domain.voxels, Connectivity::corners, pool, byte_limit - grid_bytes);
  Selection selection(components);
  if (seeds.from_infinity) selection.keep_border();
  for (const Seed& seed : seeds.points)
    if (!selection.keep_for(seed, voxels.transform)) ++domain.seeds_buried;

  for (std::uint32_t c = 0; c < components.count(); ++c) {
    const bool kept = selection.kept(c);
    ++(kept ? domain.components_kept : domain.components_dropped);
    (kept ? domain.voxels_kept : domain.voxels_dropped) += components.voxels[c];
  }
  if (domain.components_dropped > 0) drop(domain.voxels, components, selection, pool);
  return domain;
}

}  // namespace lacuna
