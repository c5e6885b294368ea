#include "renderer/geometry/surface.h"

#include "renderer/geometry/tangent_frame.h"

namespace lacuna {

namespace {

bool uses_textures(const Material& m) {
  bool any =
      m.emission_texture.used() || m.normal_texture.used() || (m.lacuna && m.lacuna->bump.used());
  m.for_each_scattering_texture([&](const TextureRef&) { any = true; });
  return any;
}

/// Moves `s`, in the coordinates of a prototype but for its point, to the scene.
void place(Surface& s, const SceneData& scene, const Hit& hit, const TriangleShape& placed) {
  const Instance& instance = scene.instances[hit.instance];
  const bool smooth = s.ns != s.ng;
  const V3f n = instance.normal(s.ns);
  s.ng = placed.ng;
  s.ns = smooth && n.length2() > 0 ? n.normalized() : s.ng;
  s.offset = ray_offset(s.x, s.ng, placed.plane_error);
  s.instance = hit.instance;
}

/// The least cosine between a bent normal and the front of the triangle: what points behind it
/// would scatter no light.
constexpr float least_cosine = 0.01F;

/// `bent`, unit, and turned to the front of the triangle as far as it lies behind; s.ns if it has
/// no direction.
V3f towards_front(V3f bent, const Surface& s) {
  const float length2 = bent.length2();
  if (!(length2 > 0)) return s.ns;
  bent /= std::sqrt(length2);
  const V3f front = dot(s.ns, s.ng) < 0 ? -s.ng : s.ng;
  if (const float lack = least_cosine - dot(bent, front); lack > 0) {
    bent = (bent + front * lack).normalized();
  }
  return bent;
}

/// The shading normal `s.ns`, in scene coordinates, bent by a normal map at barycentric `at`;
/// `s.ns` without a map, if its texture is not decoded, or if the triangle has no texture
/// coordinates. Of an instance it is bent in the scene, because normals and directions of
/// the surface transform differently.
V3f bent_normal(const SceneData& scene, const Surface& s, const V2f& at, const TextureRef& map,
                float scale) {
  if (!map.used()) return s.ns;
  const Texture& texture = *scene.textures[static_cast<std::size_t>(map.texture)];
  if (!texture.decoded()) return s.ns;
  const Mesh& mesh = scene.meshes[s.mesh];
  const auto frame = tangent_frame(scene, s, at, map);
  const auto& uvs = mesh.uvs[static_cast<std::size_t>(map.uv_set)];
  if (!frame || uvs.empty()) return s.ns;
  // glTF 2.0, section 3.9.3: from [0, 1] to [-1, 1], then x and y times the scale.
  const Rgb texel = texture.lookup(map.transform(mesh.mix(uvs, s.triangle, at))).rgb;
  const V3f n((2 * texel.x - 1) * scale, (2 * texel.y - 1) * scale, 2 * texel.z - 1);
  return towards_front(frame->to_world(n), s);
}

/// The shading normal `s.ns`, in scene coordinates, of the surface displaced along it by the height
/// of LACUNA_materials' bump map: n - grad h, up to its length (Blinn 1978, "Simulation of Wrinkled
/// Surfaces"; Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU").
V3f bumped_normal(const SceneData& scene, const Surface& s, const V2f& at) {
  const Material& m = scene.materials[s.material];
  if (!m.lacuna || !m.lacuna->bump.used()) return s.ns;
  const TextureRef& bump = m.lacuna->bump;
  const Texture& texture = *scene.textures[static_cast<std::size_t>(bump.texture)];
  if (!texture.decoded()) return s.ns;
  const auto d = texture_directions(scene, s, bump);
  if (!d) return s.ns;
  const Mesh& mesh = scene.meshes[s.mesh];
  const auto& uvs = mesh.uvs[static_cast<std::size_t>(bump.uv_set)];
  const V2f uv = bump.transform(mesh.mix(uvs, s.triangle, at));
  // The slopes of the bilinear height, each their mean over the texel around the point.
  const auto slope = [&](const V2f& half) {
    const float rise = texture.lookup(uv + half).rgb.x - texture.lookup(uv - half).rgb.x;
    return double(m.lacuna->bump_scale * rise) / (2 * double(half.x + half.y));
  };
  const double along_u = slope({0.5F / static_cast<float>(texture.size().x), 0});
  const double along_v = slope({0, 0.5F / static_cast<float>(texture.size().y)});
  // grad u and grad v are the dual basis of dx/du and dx/dv in the plane of the triangle.
  const V3d du = d->along, dv = -d->up, across = du.cross(dv);
  const double area2 = across.length2();
  if (!(area2 > 0)) return s.ns;
  const V3d gradient = (dv.cross(across) * along_u + across.cross(du) * along_v) / area2;
  const V3d n(s.ns);
  return towards_front(V3f(n - (gradient - n * n.dot(gradient))), s);
}

/// The surface with its interpolated normal.
Surface unbent(const SceneData& scene, const TriangleTable& table, const Hit& hit, const V3f& x) {
  Surface s(scene, table, hit, x);
  if (hit.instance != no_instance) place(s, scene, hit, placed_triangle(scene, table, hit));
  return s;
}

}  // namespace

V3f coat_normal(const SceneData& scene, const TriangleTable& table, const Surface& s,
                const V2f& at) {
  const Hit hit{
      .mesh = s.mesh, .triangle = s.triangle, .u = at.x, .v = at.y, .instance = s.instance};
  const ClearCoat& coat = scene.materials[s.material].extensions.coat;
  return bent_normal(scene, unbent(scene, table, hit, s.x), at, coat.normal_texture,
                     coat.normal_scale);
}

Surface Surface::of_any(const SceneData& scene, const TriangleTable& table, const Ray& ray,
                        const Hit& hit) {
  return of_any(scene, table, hit, placed_triangle(scene, table, hit).at(ray, hit.u, hit.v));
}

Surface Surface::of_any(const SceneData& scene, const TriangleTable& table, const Hit& hit,
                        const V3f& x) {
  Surface s = unbent(scene, table, hit, x);
  const Material& m = scene.materials[s.material];
  s.ns = bent_normal(scene, s, {hit.u, hit.v}, m.normal_texture, m.normal_scale);
  s.ns = bumped_normal(scene, s, {hit.u, hit.v});
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
