#include "renderer/gltf/gltf_model.h"

// The library links tinygltf as Debian compiles it, so no source defines its implementation.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <deque>
#include <new>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/json/json_text.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_compression.h"
#include "renderer/gltf/gltf_draco.h"
#include "renderer/gltf/gltf_meshopt.h"

namespace lacuna::gltf {
namespace {

/// The buffers, in the order of the glTF file, in which tinygltf requests them.
using BufferQueue = std::deque<Bytes>;

Bytes read_uri(const GltfObject& buffer, std::uint64_t needed, SceneFolder& folder,
               Hasher& content) {
  const std::string uri = buffer.string("uri");
  const bool inside = uri.starts_with("data:");
  Bytes bytes =
      inside ? decode_data_uri(buffer, uri) : folder.read(uri, buffer.label(), InputRole::buffer);
  if (bytes.size() < needed) {
    buffer.fail(in_quotes(uri) + " has " + std::to_string(bytes.size()) + " bytes; byteLength is " +
                std::to_string(needed));
  }
  if (!inside) content.add(std::span<const std::uint8_t>(bytes));
  bytes.resize(needed);  // a longer file is legal, but tinygltf wants the exact size
  return bytes;
}

/// The BIN chunk of `file`, in its memory: a copy would double that of a large scene.
Bytes bin_of(Bytes file, const Framing& framing, std::uint64_t needed) {
  const auto first = file.begin() + static_cast<std::ptrdiff_t>(framing.bin_begin);
  std::copy_n(first, needed, file.begin());
  file.resize(needed);
  return file;
}

BufferQueue read_buffers(Bytes file, const Framing& framing, const GltfObject& root,
                         SceneFolder& folder, Hasher& content) {
  BufferQueue queue;
  for (const GltfObject& buffer : root.objects("buffers")) {
    const std::uint64_t needed = buffer.integer("byteLength", 1, ~std::uint32_t{0});
    if (is_fallback(buffer)) {
      queue.emplace_back(needed);
    } else if (!buffer.has("uri")) {
      queue.push_back(bin_of(std::move(file), framing, needed));
    } else {
      queue.push_back(read_uri(buffer, needed, folder, content));
    }
  }
  return queue;
}

/// The part of the JSON of which tinygltf's model is used. All buffers have the uri of a file, and
/// primitives no indices without data, which tinygltf refuses.
std::string text_for_tinygltf(const Json& json, const GltfObject& root) {
  Json part;
  for (const char* key : {"asset", "bufferViews", "accessors", "meshes"}) {
    if (json.contains(key)) part[key] = json[key];
  }
  for (const GltfObject& buffer : root.objects("buffers")) {
    part["buffers"].push_back(
        {{"byteLength", buffer.integer("byteLength", 1, ~std::uint32_t{0})}, {"uri", "queued"}});
  }
  if (has_draco(root)) {
    const auto accessors = root.objects("accessors");
    std::size_t m = 0;
    for (const GltfObject& mesh : root.objects("meshes")) {
      Json& primitives = part["meshes"][m++]["primitives"];
      std::size_t p = 0;
      for (const GltfObject& primitive : mesh.objects("primitives")) {
        if (is_draco(primitive, accessors)) primitives[p].erase("indices");
        ++p;
      }
    }
  }
  return json_text(part);
}

/// tinygltf never accesses the file system: buffers come from the queue.
tinygltf::FsCallbacks callbacks(BufferQueue& queue) {
  tinygltf::FsCallbacks fs{};
  fs.user_data = &queue;
  fs.FileExists = [](const std::string&, void* user) {
    return !static_cast<BufferQueue*>(user)->empty();
  };
  fs.ExpandFilePath = [](const std::string& path, void*) { return path; };
  fs.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*, const std::string&,
                        void* user) {
    auto& waiting = *static_cast<BufferQueue*>(user);
    *out = std::move(waiting.front());
    waiting.pop_front();
    return true;
  };
  fs.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                         void*) { return false; };
  return fs;
}

std::string first_line(const std::string& text) {
  constexpr std::size_t longest = 200;
  return text.substr(0, std::min(text.find('\n'), longest));
}

tinygltf::Model parse_model(const std::string& text, BufferQueue queue) {
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks(callbacks(queue));
  tinygltf::Model model;
  std::string error;
  std::string warning;
  bool parsed = false;
  try {
    // No base folder: only the callbacks get the names.
    parsed = parser.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                        static_cast<unsigned>(text.size()), "");
  } catch (const std::bad_alloc&) {
    throw;  // not the fault of the file
  } catch (const std::exception& e) {
    parsed = false;
    error = e.what();
  }
  if (!parsed) throw SceneError("tinygltf: " + first_line(error));
  return model;
}

ElementType element_type(int type) {
  switch (type) {
    case TINYGLTF_TYPE_VEC2:
      return ElementType::vec2;
    case TINYGLTF_TYPE_VEC3:
      return ElementType::vec3;
    case TINYGLTF_TYPE_VEC4:
      return ElementType::vec4;
    case TINYGLTF_TYPE_MAT2:
      return ElementType::mat2;
    case TINYGLTF_TYPE_MAT3:
      return ElementType::mat3;
    case TINYGLTF_TYPE_MAT4:
      return ElementType::mat4;
    default:
      return ElementType::scalar;
  }
}

file::Sparse translated_sparse(const tinygltf::Accessor& accessor) {
  const auto& from = accessor.sparse;
  file::Sparse to;
  if (!from.isSparse) return to;
  to.count = static_cast<std::size_t>(from.count);
  to.indices_view = static_cast<std::size_t>(from.indices.bufferView);
  to.indices_offset = static_cast<std::size_t>(from.indices.byteOffset);
  to.indices_component = from.indices.componentType;
  to.values_view = static_cast<std::size_t>(from.values.bufferView);
  to.values_offset = static_cast<std::size_t>(from.values.byteOffset);
  return to;
}

file::Mesh translated(tinygltf::Mesh& from) {
  file::Mesh to{.name = std::move(from.name), .primitives = {}};
  for (tinygltf::Primitive& p : from.primitives) {
    to.primitives.push_back({.attributes = std::move(p.attributes),
                             .indices = p.indices,
                             .material = p.material,
                             .mode = p.mode,
                             .targets = std::move(p.targets)});
  }
  return to;
}

file::Model translated(tinygltf::Model from) {
  file::Model to;
  for (tinygltf::Buffer& b : from.buffers) to.buffers.push_back(std::move(b.data));
  for (const tinygltf::BufferView& v : from.bufferViews) {
    to.views.push_back(
        {static_cast<std::size_t>(v.buffer), v.byteOffset, v.byteLength, v.byteStride});
  }
  for (const tinygltf::Accessor& a : from.accessors) {
    to.accessors.push_back({.view = a.bufferView,
                            .offset = a.byteOffset,
                            .count = a.count,
                            .component = a.componentType,
                            .normalized = a.normalized,
                            .type = element_type(a.type),
                            .sparse = translated_sparse(a)});
  }
  for (tinygltf::Mesh& m : from.meshes) to.meshes.push_back(translated(m));
  return to;
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

Bytes decode_data_uri(const GltfObject& place, std::string uri) {
  for (const std::string_view kind : {"data:image/webp;base64,", "data:image/tiff;base64,"}) {
    if (uri.starts_with(kind)) uri.replace(0, kind.size(), "data:image/png;base64,");  // as known
  }
  if (!tinygltf::IsDataURI(uri)) {
    place.fail("uri is a data: URI of an unknown kind (\"" + uri.substr(0, 40) +
               "...\"); allowed: base64 of application/octet-stream, application/gltf-buffer, "
               "image/png, image/jpeg, image/webp or image/tiff");
  }
  Bytes bytes;
  std::string type;
  if (!tinygltf::DecodeDataURI(&bytes, type, uri, 0, false)) place.fail("uri is not base64");
  return bytes;
}

file::Model read_model(Bytes file, const Framing& framing, const Json& json, const GltfObject& root,
                       SceneFolder& folder, Hasher& content) {
  BufferQueue queue = read_buffers(std::move(file), framing, root, folder, content);
  file::Model model = translated(parse_model(text_for_tinygltf(json, root), std::move(queue)));
  decode_meshopt(root, model);
  decode_draco(root, model);
  return model;
}

}  // namespace lacuna::gltf
