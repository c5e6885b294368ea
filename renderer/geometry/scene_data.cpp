#include "renderer/geometry/scene_data.h"

namespace lacuna {

bool LacunaMaterial::part_chooses() const {
  const std::optional<LacunaMaterial>& base = parts[0].material->lacuna;
  return base && base->chooses();
}

V2f TextureRef::transform(const V2f& uv) const {
  // KHR_texture_transform: scale, then rotate, then translate. v points down, so a
  // counter-clockwise rotation turns the first axis towards negative v; the extension's first
  // example (lower left quadrant, rotated clockwise) fixes the sign.
  V2f out(uv.x * scale.x, uv.y * scale.y);
  if (rotation != 0) {
    const float c = std::cos(rotation);
    const float s = std::sin(rotation);
    out = V2f(c * out.x + s * out.y, c * out.y - s * out.x);
  }
  return out + offset;
}

namespace {

std::size_t triangles_of(std::span<const Mesh> meshes) {
  std::size_t count = 0;
  for (const Mesh& mesh : meshes) count += mesh.triangles.size();
  return count;
}

}  // namespace

Bounds bounds_of(std::span<const Mesh> meshes) {
  Bounds box;
  for (const Mesh& mesh : meshes) {
    for (const auto& triangle : mesh.triangles) {
      for (const auto i : triangle) box.add(mesh.positions[i]);
    }
  }
  return box;
}

void SceneData::bound_ray_errors() {
  if (instances.empty()) return;
  const Bounds box = bounds();
  const float reach = std::max(max_abs_component(V3f(box.low)), max_abs_component(V3f(box.high)));
  for (Instance& i : instances) i.set_reach(reach);
}

std::size_t SceneData::stored_triangles() const { return triangles_of(meshes); }

std::size_t SceneData::triangle_count() const {
  std::vector<std::size_t> of_prototype;
  for (const Prototype& p : prototypes) of_prototype.push_back(triangles_of(meshes_of(p)));
  std::size_t count = triangles_of(placed_meshes());
  for (const Instance& i : instances) count += of_prototype[i.prototype];
  return count;
}

Bounds SceneData::bounds() const {
  Bounds box = bounds_of(placed_meshes());
  std::vector<Bounds> of_prototype;
  for (const Prototype& p : prototypes) of_prototype.push_back(bounds_of(meshes_of(p)));
  for (const Instance& i : instances) box.add(i.bounds(of_prototype[i.prototype]));
  return box;
}

}  // namespace lacuna
