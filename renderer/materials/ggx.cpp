#include "renderer/materials/ggx.h"

#include "renderer/materials/disk.h"

namespace lacuna {
namespace {

/// Normalises a vector whose square neither vanishes nor overflows, as alpha >= ggx_min_alpha.
V3f unit(const V3f& v) { return v * (1 / std::sqrt(v.length2())); }

}  // namespace

V3f ggx_sample_visible(const V3f& wo, const V2f& alpha, const V2f& u) {
  // Stretch so that the surface becomes a hemisphere.
  const V3f v = unit({alpha.x * wo.x, alpha.y * wo.y, wo.z});
  const float side2 = v.x * v.x + v.y * v.y;
  const V3f t1 = side2 > 0 ? V3f(-v.y, v.x, 0) / std::sqrt(side2) : V3f(1, 0, 0);
  const V3f t2 = cross(v, t1);
  // The hemisphere projected along v: half a disk, and half an ellipse of height v.z.
  const V2f d = sample_disk(u);
  const float across = std::sqrt(1 - d.x * d.x);
  const float s = 0.5F * (1 + v.z);
  const float y = (1 - s) * across + s * d.y;
  const float z = std::sqrt(std::max(0.0F, 1 - d.x * d.x - y * y));
  const V3f n = d.x * t1 + y * t2 + z * v;
  return unit({alpha.x * n.x, alpha.y * n.y, std::max(0.0F, n.z)});
}

}  // namespace lacuna
