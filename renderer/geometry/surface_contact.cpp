#include "renderer/geometry/surface_contact.h"

#include <algorithm>

#include "renderer/geometry/surface.h"

namespace lacuna {

namespace {

/// Adds the plane of a triangle, unless `x` lies off it or a parallel plane has been added.
void add(SurfaceContact& contact, const TriangleShape& shape, const V3f& x, std::uint32_t mesh) {
  if (contact.count == static_cast<int>(contact.planes.size())) return;
  const float least = ray_offset(x, shape.ng, shape.plane_error);
  const V3d normal = shape.normal().normalized();
  if (std::abs(normal.dot(V3d(x) - V3d(shape.corners[0]))) > double(least)) return;
  constexpr float parallel = 0x1p-10F;  // sine of an angle between normals
  const auto is_there = [&](const SurfaceContact::Plane& p) {
    return cross(p.ng, shape.ng).length2() < parallel * parallel;
  };
  const auto end = contact.planes.begin() + contact.count;
  if (std::any_of(contact.planes.begin(), end, is_there)) return;
  // The point may lie off the plane by `least`, on either side.
  contact.planes[static_cast<std::size_t>(contact.count++)] = {shape.ng, 2 * least, mesh};
}

}  // namespace

std::optional<SurfaceContact> find_contact(const SurfaceSet& surfaces, const V3f& x) {
  // Traces segments through the point along the axes, in both directions. One axis is within 55
  // degrees of any normal. The segments are long enough for Embree to distinguish both ends from a
  // plane through the middle.
  constexpr float few_roundings = 0x1p-19F;
  const Bounds& box = surfaces.box;
  float size = max_abs_component(x);
  for (int k = 0; k < 3; ++k) {
    size = std::max({size, std::abs(static_cast<float>(box.low[k])),
                     std::abs(static_cast<float>(box.high[k]))});
  }
  const float reach = size * few_roundings;
  SurfaceContact contact;
  for (int k = 0; k < 6; ++k) {
    V3f along(0, 0, 0);
    along[k / 2] = k % 2 == 0 ? reach : -reach;
    // Continues behind each hit by this part of the segment.
    constexpr float part = 0x1p-6F;
    Hit hit;
    for (float from = 0; from < 2; from += hit.t + part) {
      if (!surfaces.rays.intersect({x + along * (from - 1), along, 2 - from}, hit)) break;
      const TriangleShape own(surfaces.scene.meshes[hit.mesh], hit.triangle);
      const bool placed = hit.instance == no_instance;
      add(contact, placed ? own : TriangleShape(own, surfaces.scene.instances[hit.instance]), x,
          hit.mesh);
    }
  }
  return contact.count > 0 ? std::optional(contact) : std::nullopt;
}

}  // namespace lacuna
