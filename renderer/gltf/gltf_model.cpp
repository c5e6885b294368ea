#include "renderer/gltf/gltf_model.h"

#include <deque>
#include <new>

#include "renderer/geometry/scene_data.h"

namespace lacuna::gltf {
namespace {

/// The external buffers in the order of the file, which is the order in which tinygltf asks.
using BufferQueue = std::deque<Bytes>;

BufferQueue read_external_buffers(const GltfObject& root, SceneFolder& folder, Hasher& content) {
  BufferQueue queue;
  for (const GltfObject& buffer : root.objects("buffers")) {
    if (!buffer.has("uri")) continue;
    const std::string uri = buffer.string("uri");
    refuse_data_uri(buffer, uri);
    if (tinygltf::IsDataURI(uri)) continue;
    Bytes bytes = folder.read(uri, buffer.label(), InputRole::buffer);
    const std::uint64_t needed = buffer.integer("byteLength", 1, bytes.max_size());
    if (bytes.size() < needed) {
      buffer.fail("\"" + uri + "\" has " + std::to_string(bytes.size()) + " bytes; byteLength is " +
                  std::to_string(needed));
    }
    content.add(std::span<const std::uint8_t>(bytes));
    bytes.resize(needed);  // a longer file is legal, but tinygltf wants the exact size
    queue.push_back(std::move(bytes));
  }
  return queue;
}

/// tinygltf never touches the file system: buffers come from the queue, images are left alone. A
/// data: URI that it does not know it takes for the name of a file.
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

}  // namespace

void refuse_data_uri(const GltfObject& place, const std::string& uri) {
  if (uri.starts_with("data:") && !tinygltf::IsDataURI(uri)) {
    place.fail("uri is a data: URI of an unknown kind (\"" + uri.substr(0, 40) +
               "...\"); allowed: base64 of application/octet-stream, application/gltf-buffer, "
               "image/png or image/jpeg");
  }
}

tinygltf::Model parse_model(std::span<const std::uint8_t> file, const Framing& framing,
                            const GltfObject& root, SceneFolder& folder, Hasher& content) {
  BufferQueue queue = read_external_buffers(root, folder, content);
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks(callbacks(queue));
  parser.SetImageLoader(keep_encoded, nullptr);
  tinygltf::Model model;
  std::string error;
  std::string warning;
  bool parsed = false;
  try {
    // No base folder: names reach nobody but the callbacks.
    if (framing.binary) {
      parsed = parser.LoadBinaryFromMemory(&model, &error, &warning, file.data(),
                                           static_cast<unsigned>(file.size()), "");
    } else {
      parsed = parser.LoadASCIIFromString(&model, &error, &warning,
                                          reinterpret_cast<const char*>(file.data()),
                                          static_cast<unsigned>(file.size()), "");
    }
  } catch (const std::bad_alloc&) {
    throw;  // says nothing of the file
  } catch (const std::exception& e) {
    parsed = false;
    error = e.what();
  }
  if (!parsed) throw SceneError("tinygltf: " + first_line(error));
  return model;
}

}  // namespace lacuna::gltf
