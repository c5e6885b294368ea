#include "analysis/skeleton/surface_lookup.h"

#include <cmath>

#include "analysis/geometry/shell.h"

namespace lacuna {
namespace {

bool finite(Imath::V3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

std::optional<Imath::V3i> SurfaceLookup::voxel(Imath::V3d x, Imath::V3d n, Imath::V3d w) const {
  if (!finite(n) || !finite(w) || n == Imath::V3d(0.0)) return {};
  const Imath::V3i size = map_->size();
  std::optional<Imath::V3i> s = voxel_at(transform_.to_grid(x), size);
  if (!s || (*map_)(*s) != no_node) return s;
  if (n.dot(w) < 0) n = -n;
  for (int radius = 1; radius <= lookup_reach; ++radius) {
    BestAlongNormal best;
    for_each_in_shell(radius, [&](Imath::V3i offset) {
      const double product = Imath::V3d(offset).dot(n);
      if (!best.beaten_by(product, offset)) return;
      const Imath::V3i v = *s + offset;
      if (in_grid(v, size) && (*map_)(v) != no_node) best.take(product, offset, v);
    });
    if (best.found()) return best.voxel;
  }
  return {};
}

}  // namespace lacuna
