#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <deque>
#include <iterator>
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

/// Gives materials their indices without reading an MTL: a file may name them with none.
class MaterialNames : public tinyobj::MaterialReader {
 public:
  /// Also finds the libraries.
  MaterialNames(std::string_view text, std::vector<std::string>& libraries) {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      const std::string_view line = text.substr(at, end - at);
      const std::size_t key = std::min(line.find_first_not_of(" \t"), line.size());
      const auto rest = [&] {
        const std::string_view tail = line.substr(key + 6);
        const std::size_t first = tail.find_first_not_of(" \t"),
                          last = tail.find_last_not_of(" \t\r");
        return first > last ? std::string() : std::string(tail.substr(first, last + 1 - first));
      };
      if (line.substr(key).starts_with("mtllib")) libraries.push_back(rest());
      if (line.substr(key).starts_with("usemtl")) {
        std::string name = rest();  // of which tinyobjloader reads the first word
        const std::string word = name.substr(0, name.find_first_of(" \t"));
        if (by_word_.try_emplace(word, static_cast<int>(names_.size())).second) {
          names_.push_back(std::move(name));
        }
      }
      at = end + 1;
    }
  }
  bool operator()(const std::string&, std::vector<tinyobj::material_t>*,
                  std::map<std::string, int>* ids, std::string*, std::string*) override {
    *ids = by_word_;
    return true;
  }
  std::string name(int id) const { return id < 0 ? "" : names_[static_cast<std::size_t>(id)]; }

 private:
  std::map<std::string, int> by_word_;
  std::vector<std::string> names_;
};

}  // namespace

ObjFile obj_file(const std::string& text, const std::string& label) {
  ObjFile file;
  MaterialNames names(text, file.libraries);
  tinyobj::attrib_t values;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warnings, errors;
  // The names are asked for where the first library is named.
  const bool late = text.find("usemtl") < text.find("mtllib");
  std::istringstream stream(late ? "mtllib names\n" + text : text);
  constexpr bool triangulate = true, white_vertices = false;
  if (!tinyobj::LoadObj(&values, &shapes, &materials, &warnings, &errors, &stream, &names,
                        triangulate, white_vertices)) {
    throw SceneError(fmt::format("{}: {}", label, errors.substr(0, errors.find('\n'))));
  }
  std::map<int, std::size_t> part_of;
  std::deque<ObjCorners> corners;
  std::deque<ObjFile::Part> parts;  // to which corners point
  for (const tinyobj::shape_t& shape : shapes) {
    const auto& indices = shape.mesh.indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      const int material = shape.mesh.material_ids[i / 3];
      const auto [part, added] = part_of.try_emplace(material, parts.size());
      if (added) {
        parts.push_back({names.name(material), {}});
        corners.emplace_back(values, label, parts.back().mesh);
      }
      ObjCorners& of = corners[part->second];
      const std::uint32_t a = of.index(indices[i]), b = of.index(indices[i + 1]),
                          c = of.index(indices[i + 2]);
      parts[part->second].mesh.triangles.push_back({a, b, c});
    }
  }
  for (ObjCorners& of : corners) of.finish();
  file.parts.assign(std::move_iterator(parts.begin()), std::move_iterator(parts.end()));
  return file;
}

std::map<std::string, SceneElement> mtl_bsdfs(const std::string& text, const std::string& folder,
                                              const std::string& place) {
  std::map<std::string, int> ids;
  std::vector<tinyobj::material_t> materials;
  std::string warnings, errors;
  std::istringstream stream(text);
  tinyobj::LoadMtl(&ids, &materials, &stream, &warnings, &errors);
  const auto value = [&](const char* tag, const char* name, const std::string& of) {
    return SceneElement{tag, {{"name", name}, {"value", of}}, {}, place};
  };
  const auto picture = [&](const char* name, std::string file) {
    std::ranges::replace(file, '\\', '/');
    return SceneElement{"texture",
                        {{"type", "bitmap"}, {"name", name}},
                        {value("string", "filename", folder + file)},
                        place};
  };
  const auto colour = [&](const char* name, const tinyobj::real_t* c, const std::string& file) {
    if (!file.empty()) return picture(name, file);
    return value("srgb", name, fmt::format("{} {} {}", c[0], c[1], c[2]));
  };
  std::map<std::string, SceneElement> out;
  for (const tinyobj::material_t& m : materials) {
    const auto bsdf = [&](const char* type, std::vector<SceneElement> inner) {
      return SceneElement{"bsdf", {{"type", type}, {"id", m.name}}, std::move(inner), place};
    };
    const bool shines = m.shininess > 0 && (!m.specular_texname.empty() ||
                                            m.specular[0] + m.specular[1] + m.specular[2] > 0);
    SceneElement made;
    if (m.illum == 2 && shines) {
      made = bsdf("phong", {colour("diffuseReflectance", m.diffuse, m.diffuse_texname),
                            colour("specularReflectance", m.specular, m.specular_texname),
                            value("float", "exponent", fmt::format("{}", m.shininess))});
    } else if (m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9) {
      made = bsdf("dielectric", {});
    } else if (m.illum == 5 || m.illum == 8) {
      made = bsdf("conductor", {value("string", "material", "Al")});
    } else {
      made = bsdf("diffuse", {colour("reflectance", m.diffuse, m.diffuse_texname)});
    }
    if (!m.bump_texname.empty()) {
      SceneElement map = picture("map", m.bump_texname);
      map.children.push_back(value("float", "gamma", "1"));
      made = bsdf("bumpmap", {std::move(map), std::move(made)});
    }
    if (!m.alpha_texname.empty()) {
      made = bsdf("mask", {picture("opacity", m.alpha_texname), std::move(made)});
    } else if (m.dissolve != 1) {
      made =
          bsdf("mask", {value("float", "opacity", fmt::format("{}", m.dissolve)), std::move(made)});
    }
    out[m.name] = std::move(made);
  }
  return out;
}

}  // namespace lacuna::mitsuba
