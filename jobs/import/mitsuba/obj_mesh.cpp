#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <array>
#include <sstream>
#include <unordered_map>

#include "jobs/import/mitsuba/mesh_files.h"
#include "renderer/core/scene_error.h"

namespace lacuna::mitsuba {
namespace {

/// Position, normal and texture coordinates of a corner; -1: none.
using Corner = std::array<int, 3>;
struct CornerHash {
  std::size_t operator()(const Corner& c) const {
    std::uint64_t h = 0;
    for (const int i : c) {
      h = (h ^ static_cast<std::uint32_t>(i)) * 0x9E3779B97F4A7C15U;
      h ^= h >> 29;
    }
    return h;
  }
};

V3f vector_at(const std::vector<float>& values, int i) {
  const auto k = 3 * static_cast<std::size_t>(i);
  return {values[k], values[k + 1], values[k + 2]};
}

class ObjCorners {
 public:
  ObjCorners(const tinyobj::attrib_t& values, const std::string& label, ImportedMesh& mesh)
      : values_(values), label_(label), mesh_(mesh) {}

  std::uint32_t index(const tinyobj::index_t& i) {
    const Corner corner{i.vertex_index, i.normal_index, i.texcoord_index};
    const auto next = static_cast<std::uint32_t>(mesh_.positions.size());
    const auto [found, added] = indices_.try_emplace(corner, next);
    if (!added) return found->second;
    check(corner[0], values_.vertices.size() / 3, "vertex", true);
    check(corner[1], values_.normals.size() / 3, "normal", false);
    check(corner[2], values_.texcoords.size() / 2, "texture coordinate", false);
    mesh_.positions.push_back(vector_at(values_.vertices, corner[0]));
    has_normals_ &= corner[1] >= 0;
    has_uvs_ &= corner[2] >= 0;
    mesh_.normals.push_back(corner[1] < 0 ? V3f(0) : vector_at(values_.normals, corner[1]));
    const auto k = 2 * static_cast<std::size_t>(std::max(0, corner[2]));
    mesh_.uvs.push_back(corner[2] < 0 ? V2f(0)
                                      : V2f(values_.texcoords[k], values_.texcoords[k + 1]));
    return next;
  }
  void finish() {
    if (!has_normals_) mesh_.normals.clear();
    if (!has_uvs_) mesh_.uvs.clear();
  }

 private:
  void check(int i, std::size_t count, const char* what, bool required) const {
    if (i >= 0 ? static_cast<std::size_t>(i) < count : !required) return;
    throw SceneError(
        fmt::format("{}: a face names {} {} of {}", label_, what, std::int64_t{i} + 1, count));
  }

  const tinyobj::attrib_t& values_;
  const std::string& label_;
  ImportedMesh& mesh_;
  bool has_normals_ = true, has_uvs_ = true;
  std::unordered_map<Corner, std::uint32_t, CornerHash> indices_;
};

}  // namespace

ImportedMesh obj_mesh(const std::string& text, const std::string& label) {
  tinyobj::attrib_t values;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warnings, errors;
  std::istringstream stream(text);
  constexpr bool triangulate = true, white_vertices = false;
  if (!tinyobj::LoadObj(&values, &shapes, &materials, &warnings, &errors, &stream, nullptr,
                        triangulate, white_vertices)) {
    throw SceneError(fmt::format("{}: {}", label, errors.substr(0, errors.find('\n'))));
  }
  ImportedMesh mesh;
  ObjCorners corners(values, label, mesh);
  for (const tinyobj::shape_t& shape : shapes) {
    const auto& indices = shape.mesh.indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      const std::uint32_t a = corners.index(indices[i]), b = corners.index(indices[i + 1]),
                          c = corners.index(indices[i + 2]);
      mesh.triangles.push_back({a, b, c});
    }
  }
  corners.finish();
  return mesh;
}

}  // namespace lacuna::mitsuba
