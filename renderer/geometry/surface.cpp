#include "renderer/geometry/surface.h"

namespace lacuna {

namespace {

bool uses_textures(const Material& m) {
  bool any = m.emission_texture.used();
  m.for_each_scattering_texture([&](const TextureRef&) { any = true; });
  return any;
}

}  // namespace

TriangleRecord::TriangleRecord(const SceneData& scene, std::uint32_t mesh_index,
                               std::uint32_t triangle)
    : TriangleShape(scene.meshes[mesh_index], triangle) {
  const Mesh& mesh = scene.meshes[mesh_index];
  const Material& m = scene.materials[mesh.material];
  smooth = !mesh.normals.empty();
  textured = uses_textures(m) && !(mesh.uvs[0].empty() && mesh.uvs[1].empty());
  two_uv_sets = !mesh.uvs[1].empty();
  emits = m.emits();
  emits_behind = emits && m.double_sided;
  material = mesh.material;
}

TriangleTable::TriangleTable(const SceneData& scene) {
  records_.reserve(scene.triangle_count());
  for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    First& first = first_.emplace_back(First{records_.size(), none});
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const TriangleRecord& r = records_.emplace_back(scene, m, t);
      if (!r.smooth && !r.textured) continue;
      if (t == 0) first.attributes = attributes_.size();
      TriangleAttributes& a = attributes_.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const auto i = mesh.triangles[t][k];
        a.uv0[k] = mesh.uvs[0].empty() ? V2f(0, 0) : mesh.uvs[0][i];
        a.normals[k] = mesh.normals.empty() ? V3f(0, 0, 0) : mesh.normals[i];
      }
    }
  }
}

}  // namespace lacuna
