#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "renderer/gltf/gltf_compression.h"
#include "renderer/gltf/gltf_draco.h"
#include "renderer/gltf/gltf_features.h"
#include "renderer/gltf/gltf_guard.h"

namespace lacuna::gltf {
namespace {

constexpr std::uint64_t max_bytes = (std::uint64_t{1} << 32) - 1;

struct Sizes {
  explicit Sizes(const GltfObject& root)
      : buffers(root.array_size("buffers")),
        buffer_views(root.array_size("bufferViews")),
        accessors(root.array_size("accessors")),
        images(root.array_size("images")),
        textures(root.array_size("textures")),
        samplers(root.array_size("samplers")),
        materials(root.array_size("materials")),
        meshes(root.array_size("meshes")),
        cameras(root.array_size("cameras")),
        nodes(root.array_size("nodes")),
        scenes(root.array_size("scenes")) {}
  std::size_t buffers, buffer_views, accessors, images, textures, samplers, materials, meshes,
      cameras, nodes, scenes;
};

void check_asset(const GltfObject& root) {
  const auto asset = root.object("asset");
  if (!asset) root.fail("asset is missing; required: an object with the glTF version");
  const std::string version = asset->string("version");
  const std::string needed = asset->string("minVersion", version);
  if (!version.starts_with("2.") || (asset->has("minVersion") && needed != "2.0")) {
    asset->refuse(asset->has("minVersion") ? "minVersion" : "version", "glTF 2.0");
  }
  for (const std::string& name : root.strings("extensionsRequired")) {
    if (extension_supported(name)) continue;
    root.fail("extensionsRequired: found " + in_quotes(name) + remedy_for(name) +
              "; allowed: " + supported_extensions());
  }
}

/// Refuses data that exist only as an unsupported extension, without the fallback of core glTF.
void refuse_compressed(const GltfObject& place) {
  const auto extensions = place.object("extensions");
  if (!extensions) return;
  for (const std::string& name : extensions->keys()) {
    if (name.find("compression") == std::string::npos) continue;
    place.fail("its data come by extension " + name +
               ", which is not supported, and there is no fallback without it" + remedy_for(name));
  }
}

void check_buffers(const GltfObject& root, const Framing& framing) {
  std::size_t i = 0;
  for (const GltfObject& buffer : root.objects("buffers")) {
    const std::uint64_t bytes = buffer.integer("byteLength", 1, max_bytes);
    if (buffer.has("uri")) {
      buffer.string("uri");
    } else if (!is_fallback(buffer) && (!framing.binary || i != 0)) {
      refuse_compressed(buffer);
      buffer.fail("uri is missing; only the first buffer of a GLB has none");
    } else if (!is_fallback(buffer) && bytes > framing.bin_bytes) {
      buffer.fail("byteLength is " + std::to_string(bytes) + "; the BIN chunk has " +
                  std::to_string(framing.bin_bytes) + " bytes");
    }
    ++i;
  }
}

void check_buffer_views(const GltfObject& root, const Sizes& sizes) {
  const auto buffers = root.objects("buffers");
  for (const GltfObject& view : root.objects("bufferViews")) {
    const auto buffer = view.index("buffer", sizes.buffers, "buffers");
    if (!buffer) view.fail("buffer is missing");
    const std::uint64_t offset = view.integer("byteOffset", 0, 0, max_bytes);
    const std::uint64_t length = view.integer("byteLength", 1, max_bytes);
    const std::uint64_t held = buffers[*buffer].integer("byteLength", 1, max_bytes);
    if (offset + length > held) {
      view.fail("bytes " + std::to_string(offset) + " to " + std::to_string(offset + length) +
                " are outside of buffers[" + std::to_string(*buffer) + "], which has " +
                std::to_string(held));
    }
    const std::uint64_t stride = view.integer("byteStride", 4, 4, 252);
    if (stride % 4 != 0) view.refuse("byteStride", "a multiple of 4");
  }
}

std::uint64_t element_bytes(const GltfObject& accessor) {
  static constexpr std::array<std::pair<std::uint64_t, std::uint64_t>, 6> component_bytes{
      {{5120, 1}, {5121, 1}, {5122, 2}, {5123, 2}, {5125, 4}, {5126, 4}}};
  static constexpr std::array<std::pair<std::string_view, std::uint64_t>, 7> component_counts{
      {{"SCALAR", 1},
       {"VEC2", 2},
       {"VEC3", 3},
       {"VEC4", 4},
       {"MAT2", 4},
       {"MAT3", 9},
       {"MAT4", 16}}};
  const std::uint64_t component = accessor.integer("componentType", 5120, 5126);
  const std::string type = accessor.string("type");
  const auto bytes = std::find_if(component_bytes.begin(), component_bytes.end(),
                                  [&](const auto& entry) { return entry.first == component; });
  const auto count = std::find_if(component_counts.begin(), component_counts.end(),
                                  [&](const auto& entry) { return entry.first == type; });
  if (bytes == component_bytes.end()) {
    accessor.refuse("componentType", "5120, 5121, 5122, 5123, 5125 or 5126");
  }
  if (count == component_counts.end()) {
    accessor.refuse("type", "SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
  }
  return bytes->second * count->second;
}

/// `count` tightly packed elements of a bufferView.
void check_packed(const GltfObject& part, const std::vector<GltfObject>& views, std::uint64_t count,
                  std::uint64_t element) {
  const auto view = part.index("bufferView", views.size(), "bufferViews");
  if (!view) part.fail("bufferView is missing");
  const std::uint64_t offset = part.integer("byteOffset", 0, 0, max_bytes);
  const std::uint64_t held = views[*view].integer("byteLength", 1, max_bytes);
  if (const std::uint64_t end = offset + count * element; end > held) {
    part.fail(std::to_string(count) + " elements end at byte " + std::to_string(end) +
              " of bufferViews[" + std::to_string(*view) + "], which has " + std::to_string(held));
  }
}

/// That its indices are below `elements`, and rising, is checked where they are read.
void check_sparse(const GltfObject& sparse, const std::vector<GltfObject>& views,
                  std::uint64_t elements, std::uint64_t element) {
  const std::uint64_t count = sparse.integer("count", 1, elements);
  const auto indices = sparse.object("indices");
  const auto values = sparse.object("values");
  if (!indices || !values) sparse.fail("indices or values is missing");
  const std::uint64_t component = indices->integer("componentType", 5121, 5125);
  if (component != 5121 && component != 5123 && component != 5125) {
    indices->refuse("componentType", "5121, 5123 or 5125");
  }
  check_packed(*indices, views, count, component == 5121 ? 1 : component == 5123 ? 2 : 4);
  check_packed(*values, views, count, element);
}

void check_accessors(const GltfObject& root, const Sizes& sizes) {
  const auto views = root.objects("bufferViews");
  for (const GltfObject& accessor : root.objects("accessors")) {
    const std::uint64_t element = element_bytes(accessor);
    const std::uint64_t count = accessor.integer("count", 1, max_bytes);
    const std::uint64_t offset = accessor.integer("byteOffset", 0, 0, max_bytes);
    accessor.boolean("normalized", false);
    if (const auto sparse = accessor.object("sparse")) {
      check_sparse(*sparse, views, count, element);
    }
    const auto view = accessor.index("bufferView", sizes.buffer_views, "bufferViews");
    if (!view) continue;
    const std::uint64_t stride = views[*view].integer("byteStride", element, 4, 252);
    if (stride < element) {
      accessor.fail("elements of " + std::to_string(element) + " bytes do not fit the byteStride " +
                    std::to_string(stride) + " of bufferViews[" + std::to_string(*view) + "]");
    }
    const std::uint64_t held = views[*view].integer("byteLength", 1, max_bytes);
    const std::uint64_t end = offset + stride * (count - 1) + element;
    if (end > held) {
      accessor.fail(std::to_string(count) + " elements end at byte " + std::to_string(end) +
                    " of bufferViews[" + std::to_string(*view) + "], which has " +
                    std::to_string(held));
    }
  }
}

void check_images(const GltfObject& root, const Sizes& sizes) {
  for (const GltfObject& image : root.objects("images")) {
    if (image.has("uri") == image.has("bufferView")) {
      image.fail("exactly one of uri and bufferView must be there");
    }
    if (image.has("uri")) image.string("uri");
    image.index("bufferView", sizes.buffer_views, "bufferViews");
    image.string("mimeType", "");
  }
  for (const GltfObject& texture : root.objects("textures")) {
    texture.index("source", sizes.images, "images");
    texture.index("sampler", sizes.samplers, "samplers");
  }
  for (const GltfObject& sampler : root.objects("samplers")) {
    for (const char* key : {"wrapS", "wrapT"}) {
      constexpr std::uint64_t clamp = 33071, mirrored = 33648, repeat = 10497;
      const std::uint64_t wrap = sampler.integer(key, repeat, 0, 65535);
      if (wrap != clamp && wrap != mirrored && wrap != repeat) {
        sampler.refuse(key, "33071 (clamp), 33648 (mirrored) or 10497 (repeat)");
      }
    }
    sampler.integer("magFilter", 9729, 9728, 9729);
    sampler.integer("minFilter", 9729, 9728, 9987);
  }
}

void check_attributes(const GltfObject& attributes, const Sizes& sizes) {
  for (const std::string& name : attributes.keys()) {
    attributes.index(name, sizes.accessors, "accessors");
  }
}

/// An accessor without a bufferView means zeros; tinygltf does not accept that for indices.
void check_data(const GltfObject& primitive, const std::vector<GltfObject>& accessors) {
  if (is_draco(primitive, accessors)) return;
  const auto lacks_data = [&](const std::optional<std::size_t>& accessor) {
    return accessor && !accessors[*accessor].has("bufferView");
  };
  const GltfObject attributes = *primitive.object("attributes");
  const auto indices = primitive.index("indices", accessors.size(), "accessors");
  for (const std::string& name : attributes.keys()) {
    const auto accessor = attributes.index(name, accessors.size(), "accessors");
    if (lacks_data(accessor) && !accessors[*accessor].has("sparse")) refuse_compressed(primitive);
  }
  if (!lacks_data(indices)) return;
  refuse_compressed(primitive);
  accessors[*indices].fail("used as indices of triangles: it has no bufferView");
}

void check_meshes(const GltfObject& root, const Sizes& sizes) {
  const auto accessors = root.objects("accessors");
  for (const GltfObject& mesh : root.objects("meshes")) {
    const auto primitives = mesh.objects("primitives");
    if (primitives.empty()) mesh.fail("primitives is missing or empty");
    for (const GltfObject& primitive : primitives) {
      const auto attributes = primitive.object("attributes");
      if (!attributes) primitive.fail("attributes is missing");
      check_attributes(*attributes, sizes);
      for (const GltfObject& target : primitive.objects("targets")) {
        check_attributes(target, sizes);
      }
      check_data(primitive, accessors);
      primitive.index("material", sizes.materials, "materials");
      primitive.integer("mode", 4, 0, 6);
    }
  }
}

/// The fourth row of a product of inverses is 0 0 0 1 except for rounding. It would divide a point
/// by 1 + w, with w the row times the point: so it is compared with the lengths of the axes.
void check_fourth_row(const GltfObject& node, const std::array<double, 16>& m) {
  constexpr double rounding = 1e-5;  // of floats, in a product of some
  if (m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1) return;
  bool close = std::abs(m[15] - 1) <= rounding;
  for (std::size_t axis = 0; axis < 12; axis += 4) {
    const double length = std::hypot(m[axis], m[axis + 1], m[axis + 2]);
    close = close && std::abs(m[axis + 3]) <= rounding * length;
  }
  const std::string found = "the fourth row of matrix is " + number_text(m[3]) + " " +
                            number_text(m[7]) + " " + number_text(m[11]) + " " +
                            number_text(m[15]) + "; allowed: 0 0 0 1";
  if (!close) node.fail(found);
  node.warn("matrix", found + ", as which it is read");
}

void check_nodes(const GltfObject& root, const Sizes& sizes) {
  for (const GltfObject& node : root.objects("nodes")) {
    node.index("mesh", sizes.meshes, "meshes");
    node.index("camera", sizes.cameras, "cameras");
    node.indices("children", sizes.nodes, "nodes");
    const Limits any{};
    const auto matrix = node.numbers<16>("matrix", any);
    const auto rotation = node.numbers<4>("rotation", any);
    const auto scale = node.numbers<3>("scale", any);
    const auto translation = node.numbers<3>("translation", any);
    if (matrix && (rotation || scale || translation)) {
      node.fail("matrix stands beside translation, rotation or scale; allowed: one or the other");
    }
    if (matrix) check_fourth_row(node, *matrix);
    if (rotation) {
      const double norm = std::hypot(std::hypot((*rotation)[0], (*rotation)[1]),
                                     std::hypot((*rotation)[2], (*rotation)[3]));
      if (!(std::abs(norm - 1) <= hair))
        node.fail("rotation has length " + std::to_string(norm) + "; allowed: 1");
    }
  }
  for (const GltfObject& scene : root.objects("scenes"))
    scene.indices("nodes", sizes.nodes, "nodes");
  root.index("scene", sizes.scenes, "scenes");
}

}  // namespace

void check_structure(const GltfObject& root, const Framing& framing) {
  const Sizes sizes(root);
  check_asset(root);
  check_buffers(root, framing);
  check_buffer_views(root, sizes);
  check_accessors(root, sizes);
  check_images(root, sizes);
  check_meshes(root, sizes);
  check_compression(root);
  check_nodes(root, sizes);
}

}  // namespace lacuna::gltf
