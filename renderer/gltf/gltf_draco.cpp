#include "renderer/gltf/gltf_draco.h"

#include <draco/compression/decode.h>

#include <array>
#include <memory>
#include <new>
#include <optional>
#include <span>

#include "renderer/gltf/gltf_compression.h"

namespace lacuna::gltf {
namespace {

/// A grid of 10^6 triangles in one plane, each of two bits at most, takes a byte for 27 of them.
constexpr std::uint64_t most_triangles_per_byte = 256;

/// A compressed primitive.
struct DracoData {
  GltfObject place;
  std::size_t view = 0;  ///< of the compressed bytes
  std::size_t indices = 0;
  struct Attribute {
    std::string name;
    std::uint32_t id = 0;  ///< in the compressed data
    std::size_t accessor = 0;
  };
  std::vector<Attribute> attributes = {};
  std::uint64_t triangles = 0, vertices = 0;
};

std::uint64_t count_of(const GltfObject& accessor) {
  return accessor.integer("count", 1, ~std::uint32_t{0});
}

DracoData draco_data(const GltfObject& primitive, const std::vector<GltfObject>& views,
                     const std::vector<GltfObject>& accessors) {
  const GltfObject extension = *primitive.extension(draco_extension);
  DracoData d{.place = extension};
  const auto view = extension.index("bufferView", views.size(), "bufferViews");
  const auto ids = extension.object("attributes");
  const auto indices = primitive.index("indices", accessors.size(), "accessors");
  if (!view || !ids) extension.fail("bufferView or attributes is missing");
  if (!indices) primitive.fail("indices is missing, which compressed data have");
  if (primitive.integer("mode", 4, 0, 6) != mode_triangles) {
    primitive.refuse("mode", "4 (triangles) for compressed data");
  }
  d.view = *view;
  d.indices = *indices;
  const std::uint64_t corners = count_of(accessors[d.indices]);
  if (corners % 3 != 0) accessors[d.indices].refuse("count", "a multiple of 3");
  d.triangles = corners / 3;
  const GltfObject all = *primitive.object("attributes");
  for (const std::string& name : ids->keys()) {
    const auto accessor = all.index(name, accessors.size(), "accessors");
    if (!accessor) ids->fail(name + " is no attribute of the primitive");
    d.attributes.push_back(
        {name, static_cast<std::uint32_t>(ids->integer(name, 0, ~std::uint32_t{0})), *accessor});
    d.vertices = count_of(accessors[*accessor]);
  }
  if (d.attributes.empty()) ids->fail("it has no attribute");
  return d;
}

/// Calls `f` with the data of each compressed primitive and the indices of its mesh and of itself.
template <class F>
void for_each_compressed(const GltfObject& root, F&& f) {
  const auto views = root.objects("bufferViews");
  const auto accessors = root.objects("accessors");
  std::size_t m = 0;
  for (const GltfObject& mesh : root.objects("meshes")) {
    std::size_t p = 0;
    for (const GltfObject& primitive : mesh.objects("primitives")) {
      if (is_draco(primitive, accessors)) f(draco_data(primitive, views, accessors), m, p);
      ++p;
    }
    ++m;
  }
}

/// The integers of Draco's bitstream: seven bits a byte, the lowest first.
std::optional<std::uint64_t> varint(std::span<const std::uint8_t>& bytes) {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 35 && !bytes.empty(); shift += 7) {
    const std::uint8_t byte = bytes.front();
    bytes = bytes.subspan(1);
    value |= std::uint64_t{byte & 0x7FU} << shift;
    if (byte < 0x80) return value;
  }
  return std::nullopt;
}

/// The decoder allocates what its header claims: so that is compared with the accessors first
/// (Draco bitstream specification 2.2, sections 3 to 5).
void check_header(const DracoData& d, std::span<const std::uint8_t> bytes) {
  constexpr std::size_t header = 11;
  constexpr std::uint8_t mesh = 1, sequential = 0, edgebreaker = 1;
  if (bytes.size() < header || !std::equal(bytes.begin(), bytes.begin() + 5, "DRACO")) {
    d.place.fail("its bufferView does not begin with a header of Draco");
  }
  if (bytes[5] != 2 || bytes[6] != 2) {
    d.place.fail("its data have version " + std::to_string(bytes[5]) + "." +
                 std::to_string(bytes[6]) + " of Draco's bitstream; allowed: 2.2");
  }
  const std::uint8_t method = bytes[8];
  if (bytes[7] != mesh || method > edgebreaker) d.place.fail("its data are no mesh of Draco");
  if ((bytes[10] & 0x80) != 0) d.place.fail("its data have metadata; allowed: none");
  bytes = bytes.subspan(method == sequential ? header : std::min(header + 1, bytes.size()));
  const auto first = varint(bytes), second = varint(bytes);
  const auto faces = method == sequential ? first : second;
  const auto points = method == sequential ? second : first;
  if (!faces || !points || *faces != d.triangles || *points > d.vertices) {
    d.place.fail("its data have other numbers of triangles or vertices than its accessors, " +
                 std::to_string(d.triangles) + " and " + std::to_string(d.vertices));
  }
}

std::optional<int> component_of(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return component_s8;
    case draco::DT_UINT8:
      return component_u8;
    case draco::DT_INT16:
      return component_s16;
    case draco::DT_UINT16:
      return component_u16;
    case draco::DT_UINT32:
      return component_u32;
    case draco::DT_FLOAT32:
      return component_float;
    default:
      return std::nullopt;
  }
}

/// Appends a copy of an accessor whose data are `bytes`; returns its index.
int add_accessor(file::Model& model, file::Accessor accessor, Bytes bytes) {
  model.views.push_back({.buffer = model.buffers.size(), .offset = 0, .bytes = bytes.size()});
  model.buffers.push_back(std::move(bytes));
  accessor.view = static_cast<int>(model.views.size() - 1);
  accessor.offset = 0;
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size() - 1);
}

std::unique_ptr<draco::Mesh> decoded(const DracoData& d, std::span<const std::uint8_t> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  auto result = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!result.ok()) {
    d.place.fail("its data cannot be decoded: " + result.status().error_msg_string());
  }
  std::unique_ptr<draco::Mesh> mesh = std::move(result).value();
  if (mesh->num_faces() != d.triangles || mesh->num_points() != d.vertices) {
    d.place.fail("its data have " + std::to_string(mesh->num_faces()) + " triangles and " +
                 std::to_string(mesh->num_points()) + " vertices, its accessors " +
                 std::to_string(d.triangles) + " and " + std::to_string(d.vertices));
  }
  return mesh;
}

Bytes indices_of(const draco::Mesh& mesh) {
  Bytes bytes(mesh.num_faces() * std::size_t{12});
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
    const std::array<std::uint32_t, 3> corners{face[0].value(), face[1].value(), face[2].value()};
    std::memcpy(bytes.data() + 12 * std::size_t{f}, corners.data(), 12);
  }
  return bytes;
}

Bytes values_of(const draco::Mesh& mesh, const DracoData::Attribute& a,
                const file::Accessor& accessor, const GltfObject& place) {
  const draco::PointAttribute* from = mesh.GetAttributeByUniqueId(a.id);
  if (from == nullptr) {
    place.fail("its data have no attribute " + std::to_string(a.id) + " for " + a.name);
  }
  const std::size_t components = component_count(accessor.type);
  const std::size_t element = components * component_bytes(accessor.component);
  if (component_of(from->data_type()) != accessor.component ||
      static_cast<std::size_t>(from->num_components()) != components ||
      static_cast<std::size_t>(from->byte_stride()) != element) {
    place.fail(a.name + " is of another type in its data than its accessor says");
  }
  Bytes bytes(mesh.num_points() * element);
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    const draco::AttributeValueIndex at = from->mapped_index(draco::PointIndex(i));
    if (at.value() >= from->size()) place.fail("its data are damaged");
    from->GetValue(at, bytes.data() + i * element);
  }
  return bytes;
}

}  // namespace

bool is_draco(const GltfObject& primitive, const std::vector<GltfObject>& accessors) {
  if (!primitive.extension(draco_extension)) return false;
  const auto lacks_data = [&](const std::optional<std::size_t>& i) {
    return i && !accessors[*i].has("bufferView") && !accessors[*i].has("sparse");
  };
  if (lacks_data(primitive.index("indices", accessors.size(), "accessors"))) return true;
  const GltfObject attributes = *primitive.object("attributes");
  const auto names = attributes.keys();
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return lacks_data(attributes.index(name, accessors.size(), "accessors"));
  });
}

std::uint64_t check_draco(const GltfObject& root) {
  std::uint64_t total = 0;
  const auto views = root.objects("bufferViews");
  for_each_compressed(root, [&](const DracoData& d, std::size_t, std::size_t) {
    const std::uint64_t bytes = views[d.view].integer("byteLength", 1, ~std::uint32_t{0});
    if (d.triangles > most_triangles_per_byte * bytes) {
      d.place.fail("claims " + std::to_string(d.triangles) + " triangles of " +
                   std::to_string(bytes) +
                   " bytes; allowed: " + std::to_string(most_triangles_per_byte) + " a byte");
    }
    constexpr std::uint64_t widest = 16;  // bytes of an element: four floats
    total += 12 * d.triangles + widest * d.vertices * d.attributes.size();
  });
  return total;
}

bool has_draco(const GltfObject& root) {
  bool any = false;
  for_each_compressed(root, [&](const DracoData&, std::size_t, std::size_t) { any = true; });
  return any;
}

void decode_draco(const GltfObject& root, file::Model& model) {
  for_each_compressed(root, [&](const DracoData& d, std::size_t m, std::size_t p) {
    const std::span<const std::uint8_t> bytes(model.bytes_of(d.view), model.views[d.view].bytes);
    check_header(d, bytes);
    const std::unique_ptr<draco::Mesh> mesh = decoded(d, bytes);
    file::Primitive& primitive = model.meshes[m].primitives[p];
    file::Accessor indices = model.accessors[d.indices];
    indices.component = component_u32;
    primitive.indices = add_accessor(model, indices, indices_of(*mesh));
    for (const DracoData::Attribute& a : d.attributes) {
      const file::Accessor accessor = model.accessors[a.accessor];
      primitive.attributes.at(a.name) =
          add_accessor(model, accessor, values_of(*mesh, a, accessor, d.place));
    }
  });
}

}  // namespace lacuna::gltf
