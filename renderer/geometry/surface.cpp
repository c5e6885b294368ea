#include "renderer/geometry/surface.h"

#include "renderer/geometry/tangent_frame.h"
#include "renderer/geometry/triangle_parts.h"

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

/// A triangle, and the same where its instance places it.
struct PlacedRecord {
  TriangleRecord record;
  TriangleShape placed;

  PlacedRecord(const SceneData& scene, const TriangleTable& table, const Hit& hit)
      : record(table.record(hit.mesh, hit.triangle)),
        placed(hit.instance == no_instance ? TriangleShape(record)
                                           : TriangleShape(record, scene.instances[hit.instance])) {
  }
};

/// The surface with its interpolated normal.
Surface unbent(const SceneData& scene, const TriangleTable& table, const PlacedRecord& of,
               const Hit& hit, const V3f& x) {
  Surface s(scene, of.record, hit, x, [&] { return table.attributes(hit.mesh, hit.triangle); });
  if (hit.instance != no_instance) place(s, scene, hit, of.placed);
  return s;
}

Surface bent(const SceneData& scene, Surface s, const Hit& hit) {
  const Material& m = scene.materials[s.material];
  s.ns = bent_normal(scene, s, {hit.u, hit.v}, m.normal_texture, m.normal_scale);
  s.ns = bumped_normal(scene, s, {hit.u, hit.v});
  return s;
}

}  // namespace

V3f coat_normal(const SceneData& scene, const TriangleTable& table, const Surface& s,
                const V2f& at) {
  const Hit hit{
      .mesh = s.mesh, .triangle = s.triangle, .u = at.x, .v = at.y, .instance = s.instance};
  const ClearCoat& coat = scene.materials[s.material].extensions.coat;
  const PlacedRecord of(scene, table, hit);
  return bent_normal(scene, unbent(scene, table, of, hit, s.x), at, coat.normal_texture,
                     coat.normal_scale);
}

Surface Surface::of_any(const SceneData& scene, const TriangleTable& table, const Ray& ray,
                        const Hit& hit) {
  const PlacedRecord of(scene, table, hit);
  return bent(scene, unbent(scene, table, of, hit, of.placed.at(ray, hit.u, hit.v)), hit);
}

Surface Surface::of_any(const SceneData& scene, const TriangleTable& table, const Hit& hit,
                        const V3f& x) {
  return bent(scene, unbent(scene, table, {scene, table, hit}, hit, x), hit);
}

TriangleShape placed_triangle(const SceneData& scene, const TriangleTable& table, const Hit& hit) {
  return PlacedRecord(scene, table, hit).placed;
}

MeshTraits::MeshTraits(const Mesh& mesh, const Material& m)
    : smooth(!mesh.normals.empty()),
      textured(uses_textures(m) && !(mesh.uvs[0].empty() && mesh.uvs[1].empty())),
      two_uv_sets(!mesh.uvs[1].empty()),
      emits(m.emits()),
      emits_behind(m.emits_behind()),
      material(mesh.material) {}

TriangleAttributes::TriangleAttributes(const Mesh& mesh, std::uint32_t triangle) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = mesh.triangles[triangle][k];
    uv0[k] = mesh.uvs[0].empty() ? V2f(0, 0) : mesh.uvs[0][i];
    normals[k] = mesh.normals.empty() ? V3f(0, 0, 0) : mesh.normals[i];
  }
}

// A million triangles with normals and texture coordinates. With more, hits cost the same with and
// without a table (docs/notebook/scenes.md).
const std::size_t TriangleTable::default_bytes = std::size_t{1} << 27;

TriangleTable::TriangleTable(const SceneData& scene, const ThreadPool& pool, std::size_t most_bytes)
    : scene_(&scene) {
  std::size_t records = 0, attributes = 0;
  for (const Mesh& mesh : scene.meshes) {
    const MeshTraits traits(mesh, scene.materials[mesh.material]);
    const bool more = traits.smooth || traits.textured;
    first_.push_back({records, more ? attributes : none, traits});
    records += mesh.triangles.size();
    if (more) attributes += mesh.triangles.size();
  }
  const std::size_t record_bytes = records * sizeof(TriangleRecord);
  records_stored_ = record_bytes <= most_bytes;
  attributes_stored_ = record_bytes + attributes * sizeof(TriangleAttributes) <= most_bytes;
  if (records_stored_) records_.resize(records);
  if (attributes_stored_) attributes_.resize(attributes);
  const std::vector<TrianglePart> parts = triangle_parts(scene.meshes);
  pool.for_each(static_cast<int>(parts.size()), [&](int i) {
    const auto [m, begin, end] = parts[static_cast<std::size_t>(i)];
    const First& first = first_[m];
    const bool more = attributes_stored_ && first.attributes != none;
    for (std::uint32_t t = begin; t < end; ++t) {
      if (records_stored_) records_.set(first.record + t, {scene.meshes[m], first.traits, t});
      if (more) attributes_.set(first.attributes + t, {scene.meshes[m], t});
    }
  });
}

}  // namespace lacuna
