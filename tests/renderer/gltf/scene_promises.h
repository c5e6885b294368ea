#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "renderer/geometry/scene_data.h"

namespace lacuna::test {

/// The first promise of SceneData that a loaded scene does not keep; empty: it keeps them all.
inline std::string broken_promise(const SceneData& scene) {
  const auto all = [](const auto& values, const auto& holds) {
    return std::all_of(values.begin(), values.end(), holds);
  };
  for (const Mesh& mesh : scene.meshes) {
    const std::size_t n = mesh.positions.size();
    const auto one_each = [n](const auto& values) { return values.empty() || values.size() == n; };
    if (!all(mesh.positions, [](const V3f& p) { return is_finite(p); })) return "finite positions";
    if (!all(mesh.normals, [](const V3f& v) { return std::abs(v.length() - 1) <= 1e-5F; })) {
      return "unit normals";
    }
    if (!one_each(mesh.normals) || !all(mesh.uvs, one_each) || !one_each(mesh.tangents) ||
        !one_each(mesh.colors)) {
      return "attributes of every vertex";
    }
    const auto in_unit = [](float x) { return x >= 0 && x <= 1; };
    if (!all(mesh.colors, [&](const V4f& c) {
          return in_unit(c.x) && in_unit(c.y) && in_unit(c.z) && in_unit(c.w);
        })) {
      return "colours from 0 to 1";
    }
    for (const auto& t : mesh.triangles) {
      if (!all(t, [n](auto i) { return i < n; })) return "indices of vertices";
    }
    if (mesh.material >= scene.materials.size()) return "materials that are there";
  }
  for (const Material& m : scene.materials) {
    bool there = true;
    const auto is_there = [&](const TextureRef& t) {
      there = there && static_cast<std::size_t>(t.texture) < scene.textures.size();
    };
    m.for_each_scattering_texture(is_there);
    if (m.normal_texture.used()) is_there(m.normal_texture);
    if (!there) return "textures that are there";
  }
  for (const CameraData& c : scene.cameras) {
    if (!(c.yfov > 0 && c.yfov < 3.1416) || !(c.height > 0)) return "a field of view";
  }
  return {};
}

}  // namespace lacuna::test
