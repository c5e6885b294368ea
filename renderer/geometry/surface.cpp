#include "renderer/geometry/surface.h"

namespace lacuna {

namespace {

bool uses_textures(const Material& m) {
  bool any = m.emission_texture.used();
  m.for_each_scattering_texture([&](const TextureRef&) { any = true; });
  return any;
}

/// Moves `s`, in the coordinates of a prototype but for its point, to the scene.
void place(Surface& s, const SceneData& scene, const Hit& hit, const TriangleShape& placed) {
  const Instance& instance = scene.instances[hit.instance];
  s.instance = hit.instance;
  const bool smooth = s.ns != s.ng;
  const V3f n = instance.normal(s.ns);
  s.ng = placed.ng;
  s.ns = smooth && n.length2() > 0 ? n.normalized() : s.ng;
  s.offset = ray_offset(s.x, s.ng, placed.plane_error);
}

}  // namespace

Surface Surface::of_instance(const SceneData& scene, const TriangleTable& table, const Ray& ray,
                             const Hit& hit) {
  const TriangleShape placed = placed_triangle(scene, table, hit);
  Surface s(scene, table, hit, placed.at(ray, hit.u, hit.v));
  place(s, scene, hit, placed);
  return s;
}

Surface Surface::of_instance(const SceneData& scene, const TriangleTable& table, const Hit& hit,
                             const V3f& x) {
  Surface s(scene, table, hit, x);
  place(s, scene, hit, placed_triangle(scene, table, hit));
  return s;
}

TriangleShape placed_triangle(const SceneData& scene, const TriangleTable& table, const Hit& hit) {
  const TriangleRecord& r = table.at(hit.mesh, hit.triangle);
  if (hit.instance == no_instance) return r;
  return {r, scene.instances[hit.instance]};
}

TriangleRecord::TriangleRecord(const SceneData& scene, std::uint32_t mesh_index,
                               std::uint32_t triangle)
    : TriangleShape(scene.meshes[mesh_index], triangle) {
  const Mesh& mesh = scene.meshes[mesh_index];
  const Material& m = scene.materials[mesh.material];
  smooth = !mesh.normals.empty();
  textured = uses_textures(m) && !(mesh.uvs[0].empty() && mesh.uvs[1].empty());
  two_uv_sets = !mesh.uvs[1].empty();
  emits = m.emits();
  emits_behind = m.emits_behind();
  material = mesh.material;
}

TriangleTable::TriangleTable(const SceneData& scene) {
  records_.reserve(scene.stored_triangles());
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
