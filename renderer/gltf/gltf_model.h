#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/gltf/gltf_guard.h"
#include "renderer/gltf/hasher.h"
#include "renderer/gltf/scene_folder.h"

namespace lacuna::gltf {

/// The numbers that glTF writes for the types of components.
inline constexpr int component_s8 = 5120, component_u8 = 5121, component_s16 = 5122,
                     component_u16 = 5123, component_u32 = 5125, component_float = 5126;

/// The modes of primitives that are made of triangles.
inline constexpr int mode_triangles = 4, mode_strip = 5, mode_fan = 6;

enum class ElementType { scalar, vec2, vec3, vec4, mat2, mat3, mat4 };

std::size_t component_bytes(int component);
std::size_t component_count(ElementType type);

/// The parts of tinygltf's model that are used, of a file that check_structure() has validated. An
/// index is -1 if the file has none.
namespace file {

struct BufferView {
  std::size_t buffer = 0, offset = 0, bytes = 0;
  std::size_t stride = 0;  ///< 0: that of its elements
};

struct Sparse {
  std::size_t count = 0;  ///< 0: nothing is replaced
  std::size_t indices_view = 0, indices_offset = 0;
  int indices_component = 0;
  std::size_t values_view = 0, values_offset = 0;
};

struct Accessor {
  int view = -1;
  std::size_t offset = 0, count = 0;
  int component = 0;
  bool normalized = false;
  ElementType type = ElementType::scalar;
  Sparse sparse;
};

/// Accessors by the names of attributes.
using Attributes = std::map<std::string, int>;

struct Primitive {
  Attributes attributes;
  int indices = -1, material = -1, mode = mode_triangles;
  std::vector<Attributes> targets;
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
};

struct Model {
  std::vector<Bytes> buffers;
  std::vector<BufferView> views;
  std::vector<Accessor> accessors;
  std::vector<Mesh> meshes;

  const std::uint8_t* bytes_of(std::size_t view, std::size_t offset = 0) const {
    return buffers[views[view].buffer].data() + views[view].offset + offset;
  }
};

}  // namespace file

/// Parses a file that check_structure() has validated, by tinygltf. The buffers take the memory of
/// `file`, if it is a GLB. External buffers are read through `folder` and enter `content`;
/// compressed data are decoded. Throws SceneError.
file::Model read_model(Bytes file, const Framing& framing, const Json& json, const GltfObject& root,
                       SceneFolder& folder, Hasher& content);

/// The bytes of the data: URI of a buffer or image. Throws SceneError for kinds that tinygltf does
/// not decode, but for WebP and TIFF, and if it is no base64.
Bytes decode_data_uri(const GltfObject& place, std::string uri);

}  // namespace lacuna::gltf
