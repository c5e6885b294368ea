#include "renderer/geometry/scene_data.h"

namespace lacuna {

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

std::size_t SceneData::triangle_count() const {
  std::size_t count = 0;
  for (const Mesh& mesh : meshes) count += mesh.triangles.size();
  return count;
}

Bounds SceneData::bounds() const {
  Bounds box;
  for (const Mesh& mesh : meshes) {
    for (const auto& triangle : mesh.triangles) {
      for (const auto i : triangle) box.add(mesh.positions[i]);
    }
  }
  return box;
}

}  // namespace lacuna
