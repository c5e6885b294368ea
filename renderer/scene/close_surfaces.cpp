#include "renderer/scene/close_surfaces.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/geometry/triangle_parts.h"

namespace lacuna {
namespace {

/// The surface of another mesh that is too close to a point.
struct Neighbour {
  std::uint32_t mesh = 0;
  double gap = 0;    ///< distance between the point and its plane
  float offset = 0;  ///< at which rays start from it, or from the point's own surface
};

/// An upper bound of the offset of rays: surfaces further away than this are not tested.
float largest_offset(const Scene& scene, const ThreadPool& pool) {
  const std::vector<TrianglePart> parts = triangle_parts(scene.data().placed_meshes());
  std::vector<float> largest(parts.size());
  pool.for_each(static_cast<int>(parts.size()), [&](int i) {
    const auto [mesh, first, last] = parts[static_cast<std::size_t>(i)];
    float& own = largest[static_cast<std::size_t>(i)];
    for (std::uint32_t t = first; t < last; ++t) {
      own = std::max(own, scene.triangle(mesh, t).plane_error);
    }
  });
  return largest.empty() ? 0 : *std::ranges::max_element(largest);
}

std::optional<Neighbour> neighbour(const Scene& scene, const TriangleShape& own, std::uint32_t mesh,
                                   float side, float coarsest) {
  const V3f x = own.at(1.0F / 3, 1.0F / 3);
  const float own_offset = ray_offset(x, own.ng, own.plane_error);
  const float away = 4 * (coarsest + own_offset);
  const V3f n = own.ng * side;
  Hit hit;
  if (!scene.rays().intersect({x + n * away, -n, 2 * away}, hit) || hit.mesh == mesh) {
    return std::nullopt;
  }
  const TriangleShape other = scene.triangle(hit);
  if (dot(other.ng, own.ng) <= 0) return std::nullopt;  // both face the gap: a box on a floor
  const V3d normal = other.normal();
  const double gap = std::abs((V3d(x) - V3d(other.corners[0])).dot(normal)) / normal.length();
  const float offset = std::max(own_offset, ray_offset(x, other.ng, other.plane_error));
  if (!(gap < double(offset))) return std::nullopt;
  return Neighbour{hit.mesh, gap, offset};
}

}  // namespace

std::vector<std::string> close_surfaces(const Scene& scene, const ThreadPool& pool) {
  constexpr std::size_t of_a_mesh = 64;
  const SceneData& data = scene.data();
  if (data.meshes.size() < 2) return {};
  const float coarsest = largest_offset(scene, pool);
  std::size_t looked_at = 0, close = 0;
  std::string first;
  for (std::uint32_t m = 0; m < data.placed_meshes().size(); ++m) {
    const std::size_t count = data.meshes[m].triangles.size();
    const std::size_t step = (count + of_a_mesh - 1) / of_a_mesh;
    for (std::size_t t = 0; t < count; t += std::max<std::size_t>(step, 1)) {
      const TriangleShape own = scene.triangle(m, static_cast<std::uint32_t>(t));
      ++looked_at;
      std::optional<Neighbour> by = neighbour(scene, own, m, 1, coarsest);
      if (!by) by = neighbour(scene, own, m, -1, coarsest);
      if (!by) continue;
      if (close++ == 0) {
        const Mesh &here = data.meshes[m], &there = data.meshes[by->mesh];
        first = fmt::format("\"{}\", {:.2g} from \"{}\", where rays start {:.2g} off the surface",
                            here.name, by->gap, there.name, by->offset);
      }
    }
  }
  if (close == 0) return {};
  return {
      fmt::format("{} of {} tested triangles lie closer to another mesh than rays resolve:  "
                  "shadows and light between them are lost; the first is of mesh {}",
                  close, looked_at, first)};
}

}  // namespace lacuna
