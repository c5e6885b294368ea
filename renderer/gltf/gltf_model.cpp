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

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_compression.h"
#include "renderer/gltf/gltf_draco.h"
#include "renderer/gltf/gltf_meshopt.h"

namespace lacuna::gltf {
namespace {

/// The buffers that tinygltf requests as files, in the order of the glTF file, in which it requests
/// them.
using BufferQueue = std::deque<Bytes>;

bool is_compressed(const GltfObject& root) {
  const auto buffers = root.objects("buffers");
  return std::any_of(buffers.begin(), buffers.end(), is_fallback) || has_draco(root);
}

Bytes read_external(const GltfObject& buffer, const std::string& uri, std::uint64_t needed,
                    SceneFolder& folder, Hasher& content) {
  Bytes bytes = folder.read(uri, buffer.label(), InputRole::buffer);
  if (bytes.size() < needed) {
    buffer.fail(in_quotes(uri) + " has " + std::to_string(bytes.size()) + " bytes; byteLength is " +
                std::to_string(needed));
  }
  content.add(std::span<const std::uint8_t>(bytes));
  bytes.resize(needed);  // a longer file is legal, but tinygltf wants the exact size
  return bytes;
}

BufferQueue read_buffers(const Framing& framing, const GltfObject& root, SceneFolder& folder,
                         Hasher& content) {
  BufferQueue queue;
  const bool bin_is_a_file = is_compressed(root);
  for (const GltfObject& buffer : root.objects("buffers")) {
    const std::uint64_t needed = buffer.integer("byteLength", 1, ~std::uint32_t{0});
    if (is_fallback(buffer)) {
      queue.emplace_back(needed);
    } else if (!buffer.has("uri")) {
      const auto bin = framing.bin();
      if (bin_is_a_file) queue.emplace_back(bin.begin(), bin.begin() + static_cast<long>(needed));
    } else {
      const std::string uri = buffer.string("uri");
      refuse_data_uri(buffer, uri);
      if (tinygltf::IsDataURI(uri)) continue;
      queue.push_back(read_external(buffer, uri, needed, folder, content));
    }
  }
  return queue;
}

/// The JSON of a compressed file without what tinygltf refuses: buffers without data, which get the
/// uri of a file, as does the BIN chunk, and indices without data.
std::string json_of_compressed(const Framing& framing, const GltfObject& root) {
  Json json = parse_json(framing.json);
  std::size_t i = 0;
  for (const GltfObject& buffer : root.objects("buffers")) {
    Json& named = json["buffers"][i++];
    if (is_fallback(buffer) || !buffer.has("uri")) named["uri"] = "queued";
  }
  const auto accessors = root.objects("accessors");
  std::size_t m = 0;
  for (const GltfObject& mesh : root.objects("meshes")) {
    Json& primitives = json["meshes"][m++]["primitives"];
    std::size_t p = 0;
    for (const GltfObject& primitive : mesh.objects("primitives")) {
      if (is_draco(primitive, accessors)) primitives[p].erase("indices");
      ++p;
    }
  }
  return json.dump();
}

/// tinygltf never accesses the file system: buffers come from the queue, images are not decoded. It
/// takes a data: URI of an unknown kind for the name of a file.
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

bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  return true;
}

std::string first_line(const std::string& text) {
  constexpr std::size_t longest = 200;
  return text.substr(0, std::min(text.find('\n'), longest));
}

/// Buffers are filled; images keep their encoded bytes only if they came as a data: URI.
tinygltf::Model parse_model(std::span<const std::uint8_t> file, const Framing& framing,
                            const GltfObject& root, SceneFolder& folder, Hasher& content) {
  BufferQueue queue = read_buffers(framing, root, folder, content);
  std::string text;
  if (is_compressed(root)) text = json_of_compressed(framing, root);
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks(callbacks(queue));
  parser.SetImageLoader(keep_encoded, nullptr);
  tinygltf::Model model;
  std::string error;
  std::string warning;
  bool parsed = false;
  try {
    // No base folder: only the callbacks get the names.
    if (framing.binary && text.empty()) {
      parsed = parser.LoadBinaryFromMemory(&model, &error, &warning, file.data(),
                                           static_cast<unsigned>(file.size()), "");
    } else {
      const auto* first = text.empty() ? reinterpret_cast<const char*>(file.data()) : text.data();
      const std::size_t size = text.empty() ? file.size() : text.size();
      parsed = parser.LoadASCIIFromString(&model, &error, &warning, first,
                                          static_cast<unsigned>(size), "");
    }
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
  for (tinygltf::Image& i : from.images) to.images.push_back(std::move(i.image));
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

void refuse_data_uri(const GltfObject& place, const std::string& uri) {
  if (uri.starts_with("data:") && !tinygltf::IsDataURI(uri)) {
    place.fail("uri is a data: URI of an unknown kind (\"" + uri.substr(0, 40) +
               "...\"); allowed: base64 of application/octet-stream, application/gltf-buffer, "
               "image/png, image/jpeg, image/webp or image/tiff");
  }
}

std::optional<Bytes> image_of_data_uri(const GltfObject& image, const std::string& uri) {
  for (const std::string_view kind : {"data:image/webp;base64,", "data:image/tiff;base64,"}) {
    if (!uri.starts_with(kind)) continue;
    Bytes bytes;
    std::string type;
    const std::string known = "data:image/png;base64," + uri.substr(kind.size());
    if (!tinygltf::DecodeDataURI(&bytes, type, known, 0, false)) image.fail("uri is not base64");
    return bytes;
  }
  refuse_data_uri(image, uri);
  return std::nullopt;
}

file::Model read_model(std::span<const std::uint8_t> file, const Framing& framing,
                       const GltfObject& root, SceneFolder& folder, Hasher& content) {
  file::Model model = translated(parse_model(file, framing, root, folder, content));
  decode_meshopt(root, model);
  decode_draco(root, model);
  return model;
}

}  // namespace lacuna::gltf
