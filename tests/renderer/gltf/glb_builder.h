#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/json/json_text.h"
#include "renderer/core/vec.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/gltf/glb_frame.h"
#include "tests/temporary_folder.h"

namespace lacuna::test {

using Bytes = std::vector<std::uint8_t>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Component types of glTF.
inline constexpr int component_s8 = 5120, component_u8 = 5121, component_s16 = 5122,
                     component_u16 = 5123, component_u32 = 5125, component_float = 5126;

/// Puts a small GLB together. Each add_ function returns the index of what it added; `json` and
/// `bin` may be changed at will before glb() or gltf().
class GlbBuilder {
 public:
  Json json = parse_own_sorted(
      R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": []})");
  Bytes bin;

  template <class T>
  std::size_t add_view(const std::vector<T>& values) {
    bin.resize((bin.size() + 3) / 4 * 4);
    const std::size_t bytes = values.size() * sizeof(T);
    const std::size_t offset = bin.size();
    bin.resize(offset + bytes);
    const auto* from = reinterpret_cast<const std::uint8_t*>(values.data());
    std::copy_n(from, bytes, bin.begin() + static_cast<std::ptrdiff_t>(offset));
    return append("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}});
  }

  template <class T>
  std::size_t add_accessor(const std::vector<T>& values, int component_type,
                           const std::string& type) {
    return append("accessors", {{"bufferView", add_view(values)},
                                {"componentType", component_type},
                                {"count", values.size()},
                                {"type", type}});
  }

  /// A mesh of one primitive; empty normals or uvs are left out, material -1 too.
  std::size_t add_mesh(const std::vector<V3f>& positions, const Triangles& triangles,
                       int material = -1, const std::vector<V3f>& normals = {},
                       const std::vector<V2f>& uvs = {}) {
    std::vector<std::uint32_t> indices;
    for (const auto& t : triangles) indices.insert(indices.end(), t.begin(), t.end());
    Json primitive;
    primitive["attributes"]["POSITION"] = add_accessor(positions, component_float, "VEC3");
    if (!normals.empty()) {
      primitive["attributes"]["NORMAL"] = add_accessor(normals, component_float, "VEC3");
    }
    if (!uvs.empty()) {
      primitive["attributes"]["TEXCOORD_0"] = add_accessor(uvs, component_float, "VEC2");
    }
    if (!triangles.empty()) primitive["indices"] = add_accessor(indices, component_u32, "SCALAR");
    if (material >= 0) primitive["material"] = material;
    return append("meshes", {{"primitives", Json::array({primitive})}});
  }

  /// A parallelogram with corners o, o+a, o+a+b, o+b and front side a x b; uv runs from o along a,
  /// b.
  std::size_t add_quad(const V3f& o, const V3f& a, const V3f& b, int material = -1) {
    return add_mesh({o, o + a, o + a + b, o + b}, {{0, 1, 2}, {0, 2, 3}}, material, {},
                    {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  }

  /// A node of the scene, e.g. {{"mesh", 0}, {"translation", {1, 2, 3}}}.
  std::size_t add_node(const Json& node) {
    const std::size_t index = append("nodes", node);
    json["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  std::size_t add_material(const Json& material) { return append("materials", material); }

  /// A perspective camera at `position` looking along -z.
  std::size_t add_camera(const std::string& name, const V3f& position, double yfov) {
    const std::size_t camera =
        append("cameras", {{"type", "perspective"},
                           {"name", name},
                           {"perspective", {{"yfov", yfov}, {"znear", 0.01}}}});
    return add_node({{"camera", camera}, {"translation", {position.x, position.y, position.z}}});
  }

  /// A KHR_lights_punctual light on a node of its own.
  std::size_t add_light(const Json& light, Json node = Json::object()) {
    Json& lights = json["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(light);
    node["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
    return add_node(node);
  }

  /// A texture from an encoded image; `sampler` may be null.
  std::size_t add_texture(const Bytes& encoded, const Json& sampler = nullptr) {
    const std::size_t image =
        append("images", {{"bufferView", add_view(encoded)}, {"mimeType", "image/png"}});
    Json texture{{"source", image}};
    if (!sampler.is_null()) texture["sampler"] = append("samplers", sampler);
    return append("textures", texture);
  }

  Bytes glb() const { return frame(json_text(with_buffer(nullptr)), bin); }

  /// The JSON alone, with the buffer under `uri`.
  std::string gltf(const std::string& uri) const { return json_text(with_buffer(uri)); }

  /// See frame_glb().
  static Bytes frame(std::string json_text, Bytes bin_chunk) {
    return frame_glb(std::move(json_text), std::move(bin_chunk));
  }

 private:
  std::size_t append(const char* array, const Json& value) {
    json[array].push_back(value);
    return json[array].size() - 1;
  }

  Json with_buffer(const Json& uri) const {
    Json out = json;
    if (!bin.empty() && !out.contains("buffers")) {
      out["buffers"] = Json::array({{{"byteLength", bin.size()}}});
      if (!uri.is_null()) out["buffers"][0]["uri"] = uri;
    }
    return out;
  }

  static_assert(sizeof(V3f) == 12 && sizeof(V2f) == 8);
};

/// One triangle in the plane z = 0, facing +z, under one node.
inline GlbBuilder triangle_scene() {
  GlbBuilder builder;
  const auto mesh = builder.add_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  builder.add_node({{"mesh", mesh}, {"name", "thing"}});
  return builder;
}

/// The scene, by way of a file.
inline SceneData load(const GlbBuilder& builder) {
  const TemporaryFolder folder;
  return load_gltf(folder.write("scene.glb", builder.glb()));
}

}  // namespace lacuna::test
