#include "analysis/skeleton/surface_lookup.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/geometry/shell.h"

namespace lacuna {
namespace {

bool finite(Imath::V3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

constexpr std::size_t neighbours = 26;

/// The offsets of the shell of radius 1, the nearest first, then in the order of
/// for_each_in_shell(): among equal products the first wins.
std::array<Imath::V3i, neighbours> nearest_first() {
  std::array<Imath::V3i, neighbours> offsets;
  std::size_t n = 0;
  for_each_in_shell(1, [&](Imath::V3i offset) { offsets[n++] = offset; });
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](const Imath::V3i& a, const Imath::V3i& b) { return a.dot(a) < b.dot(b); });
  return offsets;
}

/// The result of BestAlongNormal in the shell of radius 1, usually with one read of the map: eye
/// paths call this at every vertex.
template <class Mapped>
std::optional<Imath::V3i> best_neighbour(const Imath::V3i& s, const Imath::V3d& n,
                                         Mapped&& mapped) {
  // The corner, edge or face that n points to has the largest product and is almost always mapped;
  // along axes without a component of n no other is nearer.
  const Imath::V3i corner = sign_of(n);
  const double most = Imath::V3d(corner).dot(n);
  const auto is_needed = [&](int a) {  // not lost by rounding
    Imath::V3i nearer = corner;
    nearer[a] = 0;
    return corner[a] == 0 || most > Imath::V3d(nearer).dot(n);
  };
  if (is_needed(0) && is_needed(1) && is_needed(2)) {
    if (const Imath::V3i v = s + corner; mapped(v)) return v;
  }
  static const std::array<Imath::V3i, neighbours> offsets = nearest_first();
  std::array<double, neighbours> product;
  for (std::size_t i = 0; i < neighbours; ++i) product[i] = Imath::V3d(offsets[i]).dot(n);
  for (;;) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < neighbours; ++i) best = product[i] > product[best] ? i : best;
    if (!(product[best] > 0)) return {};
    if (const Imath::V3i v = s + offsets[best]; mapped(v)) return v;
    product[best] = 0;
  }
}

}  // namespace

std::optional<Imath::V3i> SurfaceLookup::voxel(Imath::V3d x, Imath::V3d n, Imath::V3d w) const {
  if (!finite(n) || !finite(w) || n == Imath::V3d(0.0)) return {};
  const Imath::V3i size = map_->size();
  std::optional<Imath::V3i> s = voxel_at(transform_.to_grid(x), size);
  if (!s || (*map_)(*s) != no_node) return s;
  if (n.dot(w) < 0) n = -n;
  const auto mapped = [&](const Imath::V3i& v) {
    return in_grid(v, size) && (*map_)(v) != no_node;
  };
  if (auto v = best_neighbour(*s, n, mapped)) return v;
  for (int radius = 2; radius <= lookup_reach; ++radius) {
    BestAlongNormal best;
    for_each_in_shell(radius, [&](Imath::V3i offset) {
      const double product = Imath::V3d(offset).dot(n);
      if (!best.beaten_by(product, offset)) return;
      const Imath::V3i v = *s + offset;
      if (mapped(v)) best.take(product, offset, v);
    });
    if (best.found()) return best.voxel;
  }
  return {};
}

}  // namespace lacuna
