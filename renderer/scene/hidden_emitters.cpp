#include "renderer/scene/hidden_emitters.h"

#include <fmt/format.h>

namespace lacuna {
namespace {

/// As a fraction of a triangle's longest edge: a surface at most this far away counts as in its
/// plane.
constexpr float in_its_plane = 0x1p-18F;

struct EmittingTriangle {
  std::uint32_t mesh, triangle;
};

/// Emitting triangles at regular steps, at most `most`.
std::vector<EmittingTriangle> some_emitters(const SceneData& data, std::size_t most) {
  std::size_t count = 0;
  const auto emits = [&data](const Mesh& m) { return data.materials[m.material].emits(); };
  for (const Mesh& m : data.meshes) count += emits(m) ? m.triangles.size() : 0;
  std::vector<EmittingTriangle> triangles;
  if (count == 0) return triangles;
  const std::size_t step = (count + most - 1) / most;
  std::size_t at = 0;
  for (std::uint32_t m = 0; m < data.meshes.size(); ++m) {
    if (!emits(data.meshes[m])) continue;
    for (std::uint32_t t = 0; t < data.meshes[m].triangles.size(); ++t) {
      if (at++ % step == 0) triangles.push_back({m, t});
    }
  }
  return triangles;
}

/// The mesh that a ray hits instead of a point of the emitter, on the side of `n`.
std::optional<std::uint32_t> find_occluder(const Scene& scene, const EmittingTriangle& triangle,
                                           const V3f& x, const V3f& n, float side, float beside) {
  constexpr float away = 0x1p-10F;  // of the side: so close that nothing else is likely in between
  const float distance = std::max(away * side, 2 * beside);
  Hit hit;
  if (!scene.rays().intersect({x + n * distance, -n, distance * 2}, hit)) return std::nullopt;
  const bool own = hit.mesh == triangle.mesh && hit.triangle == triangle.triangle;
  if (own || std::abs(hit.t - distance) > beside) return std::nullopt;
  return hit.mesh;
}

}  // namespace

std::vector<std::string> hidden_emitters(const Scene& scene) {
  constexpr std::size_t most = 1 << 14;
  constexpr std::array<std::array<float, 2>, 4> points{
      {{0.334F, 0.331F}, {0.09F, 0.07F}, {0.85F, 0.08F}, {0.07F, 0.84F}}};
  const SceneData& data = scene.data();
  const std::vector<EmittingTriangle> triangles = some_emitters(data, most);
  std::size_t hidden = 0;
  std::string which;
  for (const EmittingTriangle& triangle : triangles) {
    const Mesh& mesh = data.meshes[triangle.mesh];
    const TriangleShape shape(mesh, triangle.triangle);
    // In a triangle this small relative to its coordinates, the neighbours lie as close.
    const float coordinate =
        std::max({max_abs_component(shape.corners[0]), max_abs_component(shape.corners[1]),
                  max_abs_component(shape.corners[2])});
    const auto side = static_cast<float>(std::max(shape.edge(1).length(), shape.edge(2).length()));
    if (side < 0x1p-14F * coordinate) continue;
    std::optional<std::uint32_t> by;
    for (const auto& [u, v] : points) {
      const V3f x = shape.at(u, v);
      const float beside = side * in_its_plane + 2 * ray_offset(x, shape.ng, shape.plane_error);
      if (!by) by = find_occluder(scene, triangle, x, shape.ng, side, beside);
      if (!by && data.materials[mesh.material].emits_behind()) {
        by = find_occluder(scene, triangle, x, -shape.ng, side, beside);
      }
    }
    if (!by) continue;
    if (hidden++ == 0) which = fmt::format("\"{}\" by \"{}\"", mesh.name, data.meshes[*by].name);
  }
  if (hidden == 0) return {};
  return {fmt::format(
      "{} of {} emitting triangles tested are hidden by another surface in their "
      "plane, the first of mesh {}: their light is lost, or methods disagree on it; move one of "
      "them",
      hidden, triangles.size(), which)};
}

}  // namespace lacuna
