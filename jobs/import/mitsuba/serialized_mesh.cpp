#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "jobs/import/input_bytes.h"
#include "jobs/import/mitsuba/mesh_files.h"
#include "jobs/import/ply_mesh.h"
#include "renderer/core/scene_error.h"

namespace lacuna::mitsuba {
namespace {

constexpr std::uint16_t magic = 0x041C;

enum MeshFlags : std::uint32_t {
  has_normals = 0x1,
  has_uvs = 0x2,
  has_colors = 0x8,
  flat = 0x10,
  double_precision = 0x2000
};

template <class T>
T stored(std::span<const std::uint8_t> file, std::uint64_t at, const std::string& label) {
  if (at > file.size() || file.size() - at < sizeof(T)) {
    throw SceneError(label + ": it ends early");
  }
  T value;
  std::memcpy(&value, file.data() + at, sizeof value);
  return value;
}

/// The offset of a mesh: the file ends with a list of them and their number.
std::uint64_t offset_of(std::span<const std::uint8_t> file, std::uint64_t index,
                        const std::string& label) {
  const auto version = stored<std::uint16_t>(file, 2, label);
  if (stored<std::uint16_t>(file, 0, label) != magic || (version != 3 && version != 4)) {
    throw SceneError(label + ": it is no serialized mesh of Mitsuba of version 3 or 4");
  }
  const std::uint64_t width = version == 4 ? 8 : 4;
  if (file.size() < 8) throw SceneError(label + ": it ends early");
  const auto count = stored<std::uint32_t>(file, file.size() - 4, label);
  if (index >= count) {
    throw SceneError(fmt::format("{}: mesh {} is asked for; allowed: 0 to {}", label, index,
                                 std::int64_t{count} - 1));
  }
  if (count > (file.size() - 4) / width) throw SceneError(label + ": its list of meshes is torn");
  const std::uint64_t at = file.size() - 4 - width * (count - index);
  return width == 8 ? stored<std::uint64_t>(file, at, label)
                    : stored<std::uint32_t>(file, at, label);
}

/// The values of a decompressed mesh.
class MeshBytes {
 public:
  MeshBytes(std::string_view bytes, const std::string& label) : bytes_(bytes), label_(label) {}

  void read(void* to, std::uint64_t bytes) {
    if (bytes > bytes_.size()) throw SceneError(label_ + ": it ends early");
    std::memcpy(to, bytes_.data(), bytes);
    bytes_.remove_prefix(bytes);
  }
  template <class T>
  T value() {
    T v;
    read(&v, sizeof v);
    return v;
  }
  std::vector<float> floats(std::uint64_t count, bool doubles) {
    std::vector<float> out(count);
    if (!doubles && count > 0) read(out.data(), count * sizeof(float));
    if (!doubles) return out;
    for (float& f : out) f = static_cast<float>(value<double>());
    return out;
  }
  /// Throws if so many vertices and triangles do not fit into what is left.
  void check(std::uint64_t vertices, std::uint64_t triangles) const {
    constexpr std::uint64_t vertex_bytes = 12, triangle_bytes = 12;
    if (vertices <= bytes_.size() / vertex_bytes &&
        triangles <= (bytes_.size() - vertices * vertex_bytes) / triangle_bytes &&
        vertices <= 0xFFFFFFFEU) {
      return;
    }
    throw SceneError(fmt::format("{}: it claims {} vertices and {} triangles in {} bytes", label_,
                                 vertices, triangles, bytes_.size()));
  }

 private:
  std::string_view bytes_;
  const std::string& label_;
};

std::vector<V3f> vectors_of(const std::vector<float>& values) {
  std::vector<V3f> out;
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    out.emplace_back(values[i], values[i + 1], values[i + 2]);
  }
  return out;
}

}  // namespace

ImportedMesh serialized_mesh(std::span<const std::uint8_t> file, std::uint64_t index,
                             const std::string& label, bool* face_normals) {
  const std::uint64_t offset = offset_of(file, index, label);
  const auto version = stored<std::uint16_t>(file, offset + 2, label);
  if (offset > file.size() - 4 || stored<std::uint16_t>(file, offset, label) != magic) {
    throw SceneError(fmt::format("{}: mesh {} has no header", label, index));
  }
  const std::string unzipped = unzip(file.subspan(offset + 4), max_mesh_bytes, label);
  MeshBytes stream(unzipped, label);
  ImportedMesh mesh;
  const auto flags = stream.value<std::uint32_t>();
  if (version == 4) {
    constexpr std::size_t longest_name = 4096;
    while (const char c = stream.value<char>()) {
      if (mesh.name.size() == longest_name) throw SceneError(label + ": its name does not end");
      mesh.name += c;
    }
  }
  const auto vertices = stream.value<std::uint64_t>(), triangles = stream.value<std::uint64_t>();
  stream.check(vertices, triangles);
  const bool doubles = (flags & double_precision) != 0;
  mesh.positions = vectors_of(stream.floats(3 * vertices, doubles));
  if ((flags & has_normals) != 0) mesh.normals = vectors_of(stream.floats(3 * vertices, doubles));
  if ((flags & has_uvs) != 0) {
    const auto uvs = stream.floats(2 * vertices, doubles);
    for (std::size_t i = 0; i + 1 < uvs.size(); i += 2) mesh.uvs.emplace_back(uvs[i], uvs[i + 1]);
  }
  if ((flags & has_colors) != 0) {
    for (const V3f& c : vectors_of(stream.floats(3 * vertices, doubles)))
      mesh.colors.emplace_back(c);
  }
  mesh.triangles.resize(triangles);
  if (triangles > 0) stream.read(mesh.triangles.data(), triangles * sizeof(mesh.triangles[0]));
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t i : t) {
      if (i >= vertices) {
        throw SceneError(fmt::format("{}: a triangle names vertex {} of {}", label, i, vertices));
      }
    }
  }
  if (face_normals != nullptr) *face_normals = (flags & flat) != 0;
  return mesh;
}

}  // namespace lacuna::mitsuba
