#include "renderer/scene/nested_solids.h"

#include <fmt/format.h>

#include <optional>

namespace lacuna {
namespace {

constexpr std::size_t most_meshes = 4096;
constexpr int most_hits = 256;  // of one ray

bool refracts(const SceneData& data, std::uint32_t mesh) {
  const Material& m = data.materials[data.meshes[mesh].material];
  return m.extensions.volume.solid && m.transmission > 0 && m.metallic < 1;
}

/// The mesh of a solid around the outside of `mesh`: a ray outwards leaves it without having
/// entered one.
std::optional<std::uint32_t> solid_around(const Scene& scene, std::uint32_t mesh) {
  const TriangleShape& start = scene.triangle(mesh, 0);
  V3f x = start.at(0.3F, 0.4F);
  const V3f w = start.ng;
  x = offset_origin(x, w, ray_offset(x, w, start.plane_error), w);
  int entered = 0;
  Hit hit;
  for (int i = 0; i < most_hits && scene.rays().intersect({x, w}, hit); ++i) {
    const Surface s = scene.surface({x, w}, hit);
    if (refracts(scene.data(), hit.mesh)) {
      entered += dot(w, s.ng) < 0 ? 1 : -1;
      if (entered < 0) return hit.mesh;
    }
    x = offset_origin(s.x, s.ng, s.offset, w);
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> nested_solids(const Scene& scene) {
  const SceneData& data = scene.data();
  std::vector<std::uint32_t> solids;
  for (std::uint32_t m = 0; m < data.meshes.size() && solids.size() < most_meshes; ++m) {
    if (refracts(data, m)) solids.push_back(m);
  }
  if (solids.size() < 2) return {};
  int nested = 0;
  std::string first;
  for (const std::uint32_t m : solids) {
    const std::optional<std::uint32_t> around = solid_around(scene, m);
    if (!around || nested++ > 0) continue;
    first = fmt::format("mesh \"{}\" in \"{}\"", data.meshes[m].name, data.meshes[*around].name);
  }
  if (nested == 0) return {};
  return {
      fmt::format("{} transmitting meshes lie in other solids, first {}: light between them is "
                  "refracted as if air were there",
                  nested, first)};
}

}  // namespace lacuna
