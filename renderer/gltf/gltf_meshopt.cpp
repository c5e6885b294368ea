#include "renderer/gltf/gltf_meshopt.h"

#include <meshoptimizer.h>

#include "renderer/gltf/gltf_compression.h"

namespace lacuna::gltf {
namespace {

/// A bufferView that is decoded into its fallback buffer.
struct Compressed {
  GltfObject place;
  std::size_t buffer = 0;  ///< that the compressed bytes are in
  std::uint64_t offset = 0, bytes = 0;
  std::uint64_t count = 0, stride = 0;  ///< of what is decoded
  std::string mode = {}, filter = {};
};

/// The compressed form of a bufferView; none if its own buffer has its bytes.
std::optional<Compressed> compressed_form(const GltfObject& view,
                                          const std::vector<GltfObject>& buffers) {
  const auto own = view.index("buffer", buffers.size(), "buffers");
  if (!own || !is_fallback(buffers[*own])) return std::nullopt;
  const auto extension = view.extension(meshopt_extension);
  if (!extension) {
    view.fail("its buffer, buffers[" + std::to_string(*own) + "], has no data but those that " +
              std::string(meshopt_extension) + " gives, and it does not use that extension");
  }
  const auto source = extension->index("buffer", buffers.size(), "buffers");
  if (!source) extension->fail("buffer is missing");
  Compressed c{.place = *extension, .buffer = *source};
  c.offset = extension->integer("byteOffset", 0, 0, max_decoded_bytes);
  c.bytes = extension->integer("byteLength", 1, max_decoded_bytes);
  c.count = extension->integer("count", 1, max_decoded_bytes);
  c.stride = extension->integer("byteStride", 1, 256);
  c.mode = extension->string("mode");
  c.filter = extension->string("filter", "NONE");
  return c;
}

void check_source(const Compressed& c, const std::vector<GltfObject>& buffers) {
  if (is_fallback(buffers[c.buffer])) {
    c.place.refuse("buffer", "one that has data of its own");
  }
  const std::uint64_t held = buffers[c.buffer].integer("byteLength", 1, ~std::uint32_t{0});
  if (c.offset + c.bytes > held) {
    c.place.fail("bytes " + std::to_string(c.offset) + " to " + std::to_string(c.offset + c.bytes) +
                 " are outside of buffers[" + std::to_string(c.buffer) + "], which has " +
                 std::to_string(held));
  }
}

void check_format(const Compressed& c) {
  if (c.mode == "ATTRIBUTES") {
    if (c.stride % 4 != 0) c.place.refuse("byteStride", "a multiple of 4");
  } else if (c.mode == "TRIANGLES" || c.mode == "INDICES") {
    if (c.stride != 2 && c.stride != 4) c.place.refuse("byteStride", "2 or 4");
    if (c.mode == "TRIANGLES" && c.count % 3 != 0) c.place.refuse("count", "a multiple of 3");
    if (c.filter != "NONE") c.place.refuse("filter", "NONE, as mode is not ATTRIBUTES");
  } else {
    c.place.refuse("mode", "\"ATTRIBUTES\", \"TRIANGLES\" or \"INDICES\"");
  }
  if (c.filter == "OCTAHEDRAL") {
    if (c.stride != 4 && c.stride != 8) c.place.refuse("byteStride", "4 or 8, with this filter");
  } else if (c.filter == "QUATERNION") {
    if (c.stride != 8) c.place.refuse("byteStride", "8, with this filter");
  } else if (c.filter != "NONE" && c.filter != "EXPONENTIAL") {
    c.place.refuse("filter", "\"NONE\", \"OCTAHEDRAL\", \"QUATERNION\" or \"EXPONENTIAL\"");
  }
}

/// The codec spends at least two bits on sixteen bytes of vertices, and a byte on a triangle.
constexpr std::uint64_t most_bytes_per_byte = 64;

void check_sizes(const Compressed& c, const GltfObject& view, std::uint64_t& total) {
  const std::uint64_t decoded = c.count * c.stride;
  if (decoded > most_bytes_per_byte * c.bytes) {
    c.place.fail("claims " + std::to_string(decoded) + " bytes of " + std::to_string(c.bytes) +
                 " compressed ones; allowed: " + std::to_string(most_bytes_per_byte) +
                 " times as many");
  }
  const std::uint64_t held = view.integer("byteLength", 1, ~std::uint32_t{0});
  if (decoded != held) {
    c.place.fail("count times byteStride is " + std::to_string(decoded) + "; the bufferView has " +
                 std::to_string(held) + " bytes");
  }
  total += decoded;
  if (total > max_decoded_bytes) {
    c.place.fail("all compressed bufferViews down to here decode to more than " +
                 std::to_string(max_decoded_bytes) + " bytes");
  }
}

void decode(const Compressed& c, const unsigned char* from, unsigned char* to) {
  const int failed =
      c.mode == "ATTRIBUTES"  ? meshopt_decodeVertexBuffer(to, c.count, c.stride, from, c.bytes)
      : c.mode == "TRIANGLES" ? meshopt_decodeIndexBuffer(to, c.count, c.stride, from, c.bytes)
                              : meshopt_decodeIndexSequence(to, c.count, c.stride, from, c.bytes);
  if (failed != 0) {
    c.place.fail("its " + std::to_string(c.bytes) + " bytes are no " + std::to_string(c.count) +
                 " elements of mode " + c.mode);
  }
  if (c.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(to, c.count, c.stride);
  if (c.filter == "QUATERNION") meshopt_decodeFilterQuat(to, c.count, c.stride);
  if (c.filter == "EXPONENTIAL") meshopt_decodeFilterExp(to, c.count, c.stride);
}

}  // namespace

void check_meshopt(const GltfObject& root) {
  const auto buffers = root.objects("buffers");
  std::vector<std::uint64_t> filled(buffers.size());
  std::uint64_t total = 0;
  for (const GltfObject& view : root.objects("bufferViews")) {
    const auto c = compressed_form(view, buffers);
    if (!c) continue;
    check_source(*c, buffers);
    check_format(*c);
    check_sizes(*c, view, total);
    filled[*view.index("buffer", buffers.size(), "buffers")] += c->count * c->stride;
  }
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    if (!is_fallback(buffers[i])) continue;
    constexpr std::uint64_t padding = 1 << 16;
    const std::uint64_t bytes = buffers[i].integer("byteLength", 1, ~std::uint32_t{0});
    if (bytes > 2 * filled[i] + padding) {
      buffers[i].fail("byteLength is " + std::to_string(bytes) + ", of which bufferViews fill " +
                      std::to_string(filled[i]));
    }
  }
}

void decode_meshopt(const GltfObject& root, file::Model& model) {
  const auto buffers = root.objects("buffers");
  const auto views = root.objects("bufferViews");
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto c = compressed_form(views[i], buffers);
    if (!c) continue;
    const file::BufferView& view = model.views[i];
    decode(*c, model.buffers[c->buffer].data() + c->offset,
           model.buffers[view.buffer].data() + view.offset);
  }
}

}  // namespace lacuna::gltf
