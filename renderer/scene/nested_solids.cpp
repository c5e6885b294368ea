#include "renderer/scene/nested_solids.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace lacuna {
namespace {

constexpr int most_meshes = 4096;
constexpr int most_hits = 256;  // of one ray

bool refracts(const Material& m) {
  if (m.lacuna) return m.lacuna->type == LacunaMaterial::Type::dielectric;
  return m.extensions.volume.solid && m.transmission > 0 && m.metallic < 1;
}
const Material& material_of(const SceneData& data, std::uint32_t mesh) {
  return data.materials[data.meshes[mesh].material];
}

/// The mesh of a solid around the point `x`: a ray along unit `w` leaves it without having entered
/// one.
std::optional<std::uint32_t> solid_around(const Scene& scene, V3f x, const V3f& w) {
  int entered = 0;
  Hit hit;
  for (int i = 0; i < most_hits && scene.rays().intersect({x, w}, hit); ++i) {
    const Surface s = scene.surface({x, w}, hit);
    const Material& m = material_of(scene.data(), hit.mesh);
    if (refracts(m) || m.medium() != nullptr) {
      entered += dot(w, s.ng) < 0 ? 1 : -1;
      if (entered < 0) return hit.mesh;
    }
    x = offset_origin(s.x, s.ng, s.offset, w);
  }
  return std::nullopt;
}

/// The first triangle of each mesh, in all of its instances.
template <class Use>
void for_each_mesh(const SceneData& data, Use&& use) {
  Hit first{};
  for (; first.mesh < data.placed_meshes().size(); ++first.mesh) use(first);
  for (first.instance = 0; first.instance < data.instances.size(); ++first.instance) {
    const Prototype& p = data.prototypes[data.instances[first.instance].prototype];
    for (std::uint32_t k = 0; k < p.mesh_count; ++k) {
      first.mesh = p.first_mesh + k;
      use(first);
    }
  }
}

/// The same around the outside of a mesh, by a triangle of it.
std::optional<std::uint32_t> solid_around(const Scene& scene, const Hit& of) {
  const TriangleShape start = scene.triangle(of);
  const V3f x = start.at(0.3F, 0.4F);
  return solid_around(
      scene, offset_origin(x, start.ng, ray_offset(x, start.ng, start.plane_error), start.ng),
      start.ng);
}

/// Meshes in solids, and an example.
struct Nested {
  int count = 0;
  std::string first;

  void add(const SceneData& data, std::uint32_t mesh, std::uint32_t around) {
    if (count++ > 0) return;
    first = fmt::format("\"{}\" in \"{}\"", data.meshes[mesh].name, data.meshes[around].name);
  }
};

}  // namespace

std::vector<std::string> nested_solids(const Scene& scene) {
  const SceneData& data = scene.data();
  Nested solids, others;
  int tested_solids = 0, tested_others = 0;
  if (std::ranges::none_of(data.materials, refracts)) return {};
  for_each_mesh(data, [&](const Hit& of) {
    const bool solid = refracts(material_of(data, of.mesh));
    if (!solid && !scene.has_media()) return;
    if (++(solid ? tested_solids : tested_others) > most_meshes) return;
    const std::optional<std::uint32_t> around = solid_around(scene, of);
    if (!around) return;
    if (solid) {
      solids.add(data, of.mesh, *around);
    } else if (material_of(data, *around).medium() != nullptr) {
      others.add(data, of.mesh, *around);
    }
  });
  std::vector<std::string> warnings;
  if (solids.count > 0) {
    warnings.push_back(
        fmt::format("{} transmitting meshes lie in other solids, first {}: light between them is "
                    "refracted as if air were there",
                    solids.count, solids.first));
  }
  if (others.count > 0) {
    warnings.push_back(fmt::format(
        "{} meshes lie in solids that absorb, first {}: light from one of them to another, or back "
        "to itself, is not weakened",
        others.count, others.first));
  }
  return warnings;
}

std::vector<std::string> camera_in_solid(const Scene& scene, const Camera& camera) {
  if (!scene.has_media()) return {};
  const auto around = solid_around(scene, camera.position(), V3f(0.6F, 0, 0.8F));
  if (!around || material_of(scene.data(), *around).medium() == nullptr) return {};
  return {
      fmt::format("the camera lies in the solid \"{}\", which absorbs: light to it from other "
                  "meshes in there is not weakened",
                  scene.data().meshes[*around].name)};
}

}  // namespace lacuna
