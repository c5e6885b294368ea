#include "renderer/gltf/gltf_model.h"

#include <algorithm>
#include <array>
#include <utility>

#include "renderer/gltf/gltf_compression.h"
#include "renderer/gltf/gltf_data_uri.h"

namespace lacuna::gltf {
namespace {

constexpr std::uint64_t any_size = (std::uint64_t{1} << 32) - 1;

constexpr auto element_types =
    std::to_array<std::pair<std::string_view, ElementType>>({{"SCALAR", ElementType::scalar},
                                                             {"VEC2", ElementType::vec2},
                                                             {"VEC3", ElementType::vec3},
                                                             {"VEC4", ElementType::vec4},
                                                             {"MAT2", ElementType::mat2},
                                                             {"MAT3", ElementType::mat3},
                                                             {"MAT4", ElementType::mat4}});

int index_or_none(const GltfObject& place, std::string_view key, std::size_t size,
                  std::string_view target) {
  const auto index = place.index(key, size, target);
  return index ? static_cast<int>(*index) : -1;
}

Bytes bytes_named(const GltfObject& buffer, SceneFolder& folder, Hasher& content) {
  const std::string uri = buffer.string("uri");
  auto inside = decode_data_uri(buffer, uri);
  Bytes bytes = inside ? std::move(*inside) : folder.read(uri, buffer.label(), InputRole::buffer);
  const std::uint64_t needed = buffer.integer("byteLength", 1, any_size);
  if (bytes.size() < needed) {
    buffer.fail((inside ? "its data: URI has " : in_quotes(uri) + " has ") +
                std::to_string(bytes.size()) + " bytes; byteLength is " + std::to_string(needed));
  }
  if (!inside) content.add(std::span<const std::uint8_t>(bytes));
  return bytes;
}

file::Buffer read_buffer(const GltfObject& buffer, const Framing& framing, SceneFolder& folder,
                         Hasher& content) {
  if (is_fallback(buffer)) {
    return file::Buffer(Bytes(buffer.integer("byteLength", 1, max_decoded_bytes)));
  }
  if (buffer.has("uri")) return file::Buffer(bytes_named(buffer, folder, content));
  return file::Buffer(framing.bin());
}

file::BufferView read_view(const GltfObject& view, std::size_t buffers) {
  file::BufferView out;
  out.buffer = *view.index("buffer", buffers, "buffers");
  out.offset = view.integer("byteOffset", 0, 0, any_size);
  out.bytes = view.integer("byteLength", 1, any_size);
  if (view.has("byteStride")) out.stride = view.integer("byteStride", 4, 252);
  return out;
}

file::Sparse read_sparse(const GltfObject& sparse, std::size_t views) {
  const GltfObject indices = *sparse.object("indices");
  const GltfObject values = *sparse.object("values");
  file::Sparse out;
  out.count = sparse.integer("count", 1, any_size);
  out.indices_view = *indices.index("bufferView", views, "bufferViews");
  out.indices_offset = indices.integer("byteOffset", 0, 0, any_size);
  out.indices_component = static_cast<int>(indices.integer("componentType", 0, any_size));
  out.values_view = *values.index("bufferView", views, "bufferViews");
  out.values_offset = values.integer("byteOffset", 0, 0, any_size);
  return out;
}

file::Accessor read_accessor(const GltfObject& accessor, std::size_t views) {
  file::Accessor out;
  out.view = index_or_none(accessor, "bufferView", views, "bufferViews");
  out.offset = accessor.integer("byteOffset", 0, 0, any_size);
  out.count = accessor.integer("count", 1, any_size);
  out.component = static_cast<int>(accessor.integer("componentType", 0, any_size));
  out.normalized = accessor.boolean("normalized", false);
  const std::string type = accessor.string("type");
  for (const auto& [name, value] : element_types) {
    if (name == type) out.type = value;
  }
  if (const auto sparse = accessor.object("sparse")) out.sparse = read_sparse(*sparse, views);
  return out;
}

file::Attributes read_attributes(const GltfObject& attributes, std::size_t accessors) {
  file::Attributes out;
  for (const std::string& name : attributes.keys()) {
    out[name] = index_or_none(attributes, name, accessors, "accessors");
  }
  return out;
}

file::Mesh read_mesh(const GltfObject& mesh, std::size_t accessors, std::size_t materials) {
  file::Mesh out;
  out.name = mesh.string("name", "");
  for (const GltfObject& primitive : mesh.objects("primitives")) {
    file::Primitive& to = out.primitives.emplace_back();
    to.attributes = read_attributes(*primitive.object("attributes"), accessors);
    to.indices = index_or_none(primitive, "indices", accessors, "accessors");
    to.material = index_or_none(primitive, "material", materials, "materials");
    to.mode = static_cast<int>(primitive.integer("mode", mode_triangles, 0, 6));
    for (const GltfObject& target : primitive.objects("targets")) {
      to.targets.push_back(read_attributes(target, accessors));
    }
  }
  return out;
}

}  // namespace

std::size_t component_bytes(int component) {
  if (component == component_s8 || component == component_u8) return 1;
  return component == component_s16 || component == component_u16 ? 2 : 4;
}

std::size_t component_count(ElementType type) {
  constexpr std::array<std::size_t, 7> counts{1, 2, 3, 4, 4, 9, 16};
  return counts[static_cast<std::size_t>(type)];
}

file::Model read_model(const Framing& framing, const GltfObject& root, SceneFolder& folder,
                       Hasher& content) {
  file::Model model;
  for (const GltfObject& buffer : root.objects("buffers")) {
    model.buffers.push_back(read_buffer(buffer, framing, folder, content));
  }
  for (const GltfObject& view : root.objects("bufferViews")) {
    model.views.push_back(read_view(view, model.buffers.size()));
  }
  for (const GltfObject& accessor : root.objects("accessors")) {
    model.accessors.push_back(read_accessor(accessor, model.views.size()));
  }
  for (const GltfObject& mesh : root.objects("meshes")) {
    model.meshes.push_back(read_mesh(mesh, model.accessors.size(), root.array_size("materials")));
  }
  decode_compressed(root, model);
  return model;
}

}  // namespace lacuna::gltf
