#include "renderer/gltf/gltf_draco.h"

#include <draco/compression/decode.h>

#include <cstring>
#include <span>
#include <stdexcept>

#include "renderer/gltf/gltf_compression.h"

namespace lacuna::gltf {
namespace {

/// The sizes that a Draco stream claims in its first bytes.
struct Claim {
  std::uint64_t vertices = 0, triangles = 0;
};

/// Reads the header and the first fields of the connectivity of a stream (Draco Bitstream
/// Specification 2.2): the library allocates what they say.
class HeaderReader {
 public:
  HeaderReader(std::span<const unsigned char> bytes, const GltfObject& place)
      : bytes_(bytes), place_(place) {}

  Claim read() {
    for (const char letter : std::string_view("DRACO")) {
      if (byte() != static_cast<unsigned char>(letter)) place_.fail("its data are not of Draco");
    }
    const unsigned major = byte();
    const unsigned minor = byte();
    if (major != 2 || minor != 2) {
      place_.fail("its data are of Draco's bitstream " + std::to_string(major) + "." +
                  std::to_string(minor) + "; allowed: 2.2");
    }
    constexpr unsigned mesh = 1, edgebreaker = 1, metadata = 0x80;
    if (byte() != mesh) place_.fail("its Draco data are a point cloud; allowed: a mesh");
    const unsigned method = byte();
    byte();
    if ((byte() & metadata) != 0) place_.fail("its Draco data have metadata; allowed: none");
    if (method == edgebreaker) byte();  // how connectivity is coded
    const std::uint64_t first = number();
    const std::uint64_t second = number();
    return method == edgebreaker ? Claim{first, second} : Claim{second, first};
  }

 private:
  unsigned byte() {
    if (at_ >= bytes_.size()) place_.fail("its Draco data end in their header");
    return bytes_[at_++];
  }
  /// Seven bits a byte, the lowest first; the eighth says that more follow.
  std::uint64_t number() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
      const std::uint64_t b = byte();
      value |= (b & 0x7F) << shift;
      if ((b & 0x80) == 0) break;
    }
    return value;
  }

  std::span<const unsigned char> bytes_;
  const GltfObject& place_;
  std::size_t at_ = 0;
};

/// Nearly nothing is spent on a flat grid.
constexpr std::uint64_t most_elements_per_byte = 256;
constexpr std::uint64_t always_allowed = 1 << 16;

template <class T>
void convert(const draco::PointAttribute& from, std::size_t points, int components,
             const GltfObject& place, std::vector<unsigned char>& out) {
  const std::size_t element = sizeof(T) * static_cast<std::size_t>(components);
  out.resize(points * element);
  std::array<T, 16> value{};
  for (std::size_t p = 0; p < points; ++p) {
    const auto at = from.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(p)));
    if (at.value() >= from.size() ||
        !from.ConvertValue<T>(at, static_cast<std::int8_t>(components), value.data())) {
      place.fail("its Draco data have no value of vertex " + std::to_string(p));
    }
    std::memcpy(out.data() + p * element, value.data(), element);
  }
}

std::vector<unsigned char> values_of(const draco::PointAttribute& from, std::size_t points,
                                     const file::Accessor& as, const GltfObject& place) {
  std::vector<unsigned char> out;
  const auto components = static_cast<int>(component_count(as.type));
  if (components != from.num_components()) {
    place.fail("a Draco attribute has " + std::to_string(from.num_components()) +
               " components; its accessor has " + std::to_string(components));
  }
  if (!from.is_mapping_identity() && from.indices_map_size() < points) {
    place.fail("a Draco attribute lacks vertices");
  }
  switch (as.component) {
    case component_s8:
      convert<std::int8_t>(from, points, components, place, out);
      break;
    case component_u8:
      convert<std::uint8_t>(from, points, components, place, out);
      break;
    case component_s16:
      convert<std::int16_t>(from, points, components, place, out);
      break;
    case component_u16:
      convert<std::uint16_t>(from, points, components, place, out);
      break;
    case component_u32:
      convert<std::uint32_t>(from, points, components, place, out);
      break;
    default:
      convert<float>(from, points, components, place, out);
  }
  return out;
}

template <class T>
std::vector<unsigned char> indices_of(const draco::Mesh& mesh, const GltfObject& place) {
  std::vector<unsigned char> out(std::size_t{mesh.num_faces()} * 3 * sizeof(T));
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t index = mesh.face(draco::FaceIndex(f))[k].value();
      const T value = static_cast<T>(index);
      if (value != index) {
        place.fail("vertex " + std::to_string(index) + " does not fit the accessor of its indices");
      }
      std::memcpy(out.data() + (std::size_t{f} * 3 + k) * sizeof(T), &value, sizeof(T));
    }
  }
  return out;
}

/// Gives an accessor bytes of its own.
void set_data(file::Model& model, file::Accessor& accessor, std::vector<unsigned char> bytes) {
  file::BufferView view;
  view.buffer = model.buffers.size();
  view.bytes = bytes.size();
  accessor.view = static_cast<int>(model.views.size());
  accessor.offset = 0;
  model.views.push_back(view);
  model.buffers.emplace_back(std::move(bytes));
}

void check_count(const GltfObject& place, const std::string& what, std::uint64_t found,
                 std::uint64_t accessor) {
  if (found == accessor) return;
  place.fail("its Draco data have " + std::to_string(found) + " " + what + "; its accessors have " +
             std::to_string(accessor));
}

std::unique_ptr<draco::Mesh> decode_mesh(std::span<const unsigned char> bytes,
                                         const GltfObject& place) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  try {
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok()) {
      place.fail("its Draco data are broken: " + mesh.status().error_msg_string());
    }
    return std::move(mesh).value();
  } catch (const std::length_error&) {
    place.fail("its Draco data are broken: they claim more than memory can hold");
  }
}

void decode_primitive(const GltfObject& primitive, const GltfObject& draco,
                      const std::vector<GltfObject>& accessors, file::Model& model) {
  const std::size_t view = *draco.index("bufferView", model.views.size(), "bufferViews");
  const std::span<const unsigned char> bytes(model.bytes_of(view), model.views[view].bytes);
  const auto attributes = *primitive.object("attributes");
  const auto held = *draco.object("attributes");
  const auto accessor = [&](const GltfObject& owner, const std::string& key) {
    return owner.index(key, accessors.size(), "accessors");
  };
  file::Accessor& indices = model.accessors[*accessor(primitive, "indices")];
  const std::uint64_t vertices = model.accessors[*accessor(attributes, held.keys().front())].count;
  const Claim claim = HeaderReader(bytes, draco).read();
  check_count(draco, "indices", 3 * claim.triangles, indices.count);
  if (claim.vertices > vertices) check_count(draco, "vertices", claim.vertices, vertices);
  if (claim.triangles + vertices > always_allowed + most_elements_per_byte * bytes.size()) {
    draco.fail("claims " + std::to_string(claim.triangles) + " triangles and " +
               std::to_string(vertices) + " vertices in " + std::to_string(bytes.size()) +
               " bytes; allowed: " + std::to_string(most_elements_per_byte) + " for a byte");
  }
  const auto mesh = decode_mesh(bytes, draco);
  for (const std::string& name : held.keys()) {
    file::Accessor& to = model.accessors[*accessor(attributes, name)];
    check_count(draco, "vertices", mesh->num_points(), to.count);
    const std::uint64_t id = held.integer(name, 0, ~std::uint32_t{0});
    const auto* from = mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    if (from == nullptr) held.refuse(name, "the id of an attribute in its Draco data");
    set_data(model, to, values_of(*from, mesh->num_points(), to, held));
  }
  check_count(draco, "indices", std::uint64_t{mesh->num_faces()} * 3, indices.count);
  set_data(model, indices,
           indices.component == component_u8    ? indices_of<std::uint8_t>(*mesh, draco)
           : indices.component == component_u16 ? indices_of<std::uint16_t>(*mesh, draco)
                                                : indices_of<std::uint32_t>(*mesh, draco));
}

/// Calls `f` with each primitive that needs its Draco data, and those.
template <class F>
void for_each_needed(const GltfObject& root, const std::vector<GltfObject>& accessors, F&& f) {
  for (const GltfObject& mesh : root.objects("meshes")) {
    for (const GltfObject& primitive : mesh.objects("primitives")) {
      if (const auto draco = needed_draco(primitive, accessors)) f(primitive, *draco);
    }
  }
}

}  // namespace

void check_draco(const GltfObject& root) {
  const auto accessors = root.objects("accessors");
  const auto buffers = root.objects("buffers");
  const auto views = root.objects("bufferViews");
  std::uint64_t total = 0;
  for_each_needed(root, accessors, [&](const GltfObject& primitive, const GltfObject& draco) {
    const auto view = draco.index("bufferView", views.size(), "bufferViews");
    if (!view) draco.fail("bufferView is missing");
    constexpr std::uint64_t triangles = 4;
    if (primitive.integer("mode", triangles, 0, 6) != triangles) {
      primitive.refuse("mode", "4 (triangles), as its data are of Draco");
    }
    const auto held = *draco.object("attributes");
    const auto attributes = *primitive.object("attributes");
    if (held.keys().empty()) draco.fail("attributes is empty");
    for (const std::string& name : held.keys()) {
      const auto accessor = attributes.index(name, accessors.size(), "accessors");
      if (!accessor) held.refuse(name, "only attributes that the primitive has");
      total += accessors[*accessor].integer("count", 1, ~std::uint32_t{0});
    }
    const auto indices = primitive.index("indices", accessors.size(), "accessors");
    if (!indices) primitive.fail("indices is missing, which its Draco data have");
    total += accessors[*indices].integer("count", 1, ~std::uint32_t{0});
    if (total > max_decoded_elements) {
      draco.fail("all Draco data down to here have more than " +
                 std::to_string(max_decoded_elements) + " elements");
    }
  });
}

void decode_draco(const GltfObject& root, file::Model& model) {
  const auto accessors = root.objects("accessors");
  for_each_needed(root, accessors, [&](const GltfObject& primitive, const GltfObject& draco) {
    decode_primitive(primitive, draco, accessors, model);
  });
}

}  // namespace lacuna::gltf
