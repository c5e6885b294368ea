#include <nlohmann/json.hpp>

#include "base/json/json_text.h"
#include "base/storage/atomic_file.h"
#include "jobs/cli/overlay.h"
#include "renderer/scene/scene_shape.h"

namespace lacuna {
namespace {

/// Builds a glTF document with one buffer.
class Document {
 public:
  /// Positions are relative to `origin`.
  explicit Document(const V3d& origin) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "lacuna analyze"}};
    json_["scene"] = 0;
    json_["nodes"].push_back({{"name", "origin"},
                              {"translation", {origin.x, origin.y, origin.z}},
                              {"children", OrderedJson::array()}});
    json_["scenes"] = {{{"nodes", {0}}}};
  }

  void add(const OverlayMesh& mesh, float alpha) {
    if (mesh.triangles.empty()) return;
    add_node({{"name", mesh.name}, {"mesh", add_mesh(mesh, alpha)}});
  }
  void place(std::size_t mesh, const TriangleSoup::Placement& placement) {
    OrderedJson matrix = OrderedJson::array();
    const auto push = [&matrix](const V3f& column, int last) {
      for (int k = 0; k < 3; ++k) matrix.push_back(column[k]);
      matrix.push_back(last);
    };
    for (const V3f& axis : placement.axes) push(axis, 0);
    push(placement.at, 1);
    add_node({{"mesh", mesh}, {"matrix", matrix}});
  }
  /// Returns its index.
  std::size_t add_mesh(const OverlayMesh& mesh, float alpha) {
    V3f low = mesh.positions[0], high = low;
    for (const V3f& p : mesh.positions) {
      for (int a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], p[a]);
        high[a] = std::max(high[a], p[a]);
      }
    }
    constexpr int floats = 5126, uints = 5125;
    const int positions = accessor(mesh.positions.data(), mesh.positions.size() * sizeof(V3f),
                                   {{"componentType", floats},
                                    {"count", mesh.positions.size()},
                                    {"type", "VEC3"},
                                    {"min", {low.x, low.y, low.z}},
                                    {"max", {high.x, high.y, high.z}}});
    const int indices = accessor(
        mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]),
        {{"componentType", uints}, {"count", mesh.triangles.size() * 3}, {"type", "SCALAR"}});
    OrderedJson material = {
        {"name", mesh.name},
        {"doubleSided", true},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {mesh.colour.x, mesh.colour.y, mesh.colour.z, alpha}},
          {"metallicFactor", 0}}}};
    if (alpha < 1) material["alphaMode"] = "BLEND";
    json_["materials"].push_back(material);
    json_["meshes"].push_back({{"name", mesh.name},
                               {"primitives",
                                {{{"attributes", {{"POSITION", positions}}},
                                  {"indices", indices},
                                  {"material", json_["materials"].size() - 1}}}}});
    return json_["meshes"].size() - 1;
  }

  void add(const CameraData& camera) {
    json_["cameras"].push_back({{"type", "perspective"},
                                {"name", camera.name},
                                {"perspective", {{"yfov", camera.yfov}, {"znear", 0.01}}}});
    OrderedJson matrix = OrderedJson::array();  // row vectors are glTF's columns
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) matrix.push_back(camera.to_world[row][column]);
    }
    add_node({{"name", camera.name}, {"camera", json_["cameras"].size() - 1}, {"matrix", matrix}});
  }

  std::string glb() {
    json_["buffers"] = {{{"byteLength", buffer_.size()}}};
    std::string text = json_text(json_);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string file;
    const auto put = [&file](std::size_t value) {
      const auto v = static_cast<std::uint32_t>(value);
      file.append(reinterpret_cast<const char*>(&v), sizeof v);
    };
    constexpr std::uint32_t magic = 0x46546c67, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;
    put(magic), put(2), put(12 + 8 + text.size() + 8 + buffer_.size());
    put(text.size()), put(json_chunk);
    file += text;
    put(buffer_.size()), put(binary_chunk);
    return file + buffer_;
  }

 private:
  int accessor(const void* data, std::size_t bytes, OrderedJson what) {
    json_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes}});
    buffer_.append(static_cast<const char*>(data), bytes);
    what["bufferView"] = json_["bufferViews"].size() - 1;
    json_["accessors"].push_back(std::move(what));
    return static_cast<int>(json_["accessors"].size()) - 1;
  }
  void add_node(OrderedJson node) {
    json_["nodes"].push_back(std::move(node));
    json_["nodes"][0]["children"].push_back(json_["nodes"].size() - 1);
  }

  OrderedJson json_;
  std::string buffer_;
};

}  // namespace

void write_overlay(const std::filesystem::path& file, const SceneData& scene,
                   const std::vector<OverlayMesh>& overlay) {
  Document document(scene.origin);
  TriangleSoup soup = triangle_soup(scene);
  constexpr float grey = 0.6F, see_through = 0.25F;
  document.add({"scene", Rgb(grey), std::move(soup.positions), std::move(soup.triangles)},
               see_through);
  std::vector<std::size_t> prototypes;
  for (auto& p : soup.prototypes) {
    prototypes.push_back(document.add_mesh(
        {"scene", Rgb(grey), std::move(p.positions), std::move(p.triangles)}, see_through));
  }
  for (const auto& placement : soup.placements) {
    document.place(prototypes[placement.prototype], placement);
  }
  for (const OverlayMesh& mesh : overlay) document.add(mesh, 1);
  for (const CameraData& camera : scene.cameras) document.add(camera);
  write_file_atomically(file, document.glb());
}

}  // namespace lacuna
