#include "jobs/import/scene_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "base/storage/atomic_file.h"
#include "jobs/import/environment_write.h"
#include "jobs/import/glb_document.h"
#include "jobs/import/imported_materials.h"
#include "jobs/import/imported_textures.h"
#include "jobs/import/job_write.h"
#include "jobs/import/mesh_normals.h"
#include "renderer/core/scene_error.h"

namespace lacuna {
namespace {

/// The same triangles with the other side in front.
ImportedMesh turned_over(const ImportedMesh& mesh) {
  ImportedMesh out = mesh;
  for (auto& t : out.triangles) std::swap(t[1], t[2]);
  for (V3f& n : out.normals) n = -n;
  return out;
}

/// `seen`: materials that are known to have no textures.
bool is_textured(const ImportedMaterial& m, std::set<const ImportedMaterial*>& seen) {
  if (!seen.insert(&m).second) return false;
  const bool own = m.diffuse.texture || m.reflectance.texture || m.transmittance.texture ||
                   m.opacity.texture || m.alpha_texture || m.weight_texture || m.normal_map ||
                   m.bump_map || m.roughness_texture || m.metallic_texture;
  return own || std::any_of(m.parts.begin(), m.parts.end(),
                            [&](const auto& part) { return is_textured(*part.material, seen); });
}

class SceneWriter {
 public:
  SceneWriter(const ImportedScene& scene, const std::filesystem::path& folder,
              std::vector<ImportNote>& notes)
      : scene_(scene),
        notes_(notes),
        textures_(document_, folder, notes),
        materials_(document_, textures_, notes) {}

  std::string glb() {
    for (const ImportedShape& shape : scene_.shapes) add(shape);
    for (const ImportedLight& light : scene_.lights) add(light);
    for (const ImportedCamera& camera : scene_.cameras) add(camera);
    name_extensions();
    return document_.glb();
  }

 private:
  /// The accessors of a mesh; the same for each material.
  const OrderedJson& geometry(const ImportedMesh& mesh, bool flipped) {
    auto [found, added] = geometries_.try_emplace({&mesh, flipped});
    if (!added) return found->second;
    const ImportedMesh turned = flipped ? turned_over(mesh) : ImportedMesh{};
    const ImportedMesh& m = flipped ? turned : mesh;
    OrderedJson& json = found->second;
    json["attributes"]["POSITION"] = document_.add_positions(m.positions);
    if (!m.normals.empty()) json["attributes"]["NORMAL"] = document_.add_vectors(unit_normals(m));
    if (!m.uvs.empty()) {
      std::vector<V2f> uvs = m.uvs;  // glTF's v points down
      for (V2f& uv : uvs) uv.y = 1 - uv.y;
      json["attributes"]["TEXCOORD_0"] = document_.add_vectors(uvs);
    }
    if (!m.colors.empty()) json["attributes"]["COLOR_0"] = document_.add_colors(m.colors);
    json["indices"] = document_.add_triangles(m.triangles);
    return json;
  }

  static const std::string& name_of(const ImportedShape& shape) {
    return shape.name.empty() ? shape.mesh->name : shape.name;
  }

  /// Textures of a mesh without coordinates show their upper left corner only.
  void note_lacking_uvs(const ImportedShape& shape) {
    if (!shape.mesh->uvs.empty()) return;
    std::set<const ImportedMaterial*> seen;
    const bool lit = shape.radiance && shape.radiance->texture;
    if (!lit && !is_textured(*shape.material, seen)) return;
    notes_.push_back({shape.place, name_of(shape), "approximated",
                      "it has textures and no texture coordinates"});
  }

  void add(const ImportedShape& shape) {
    if (shape.mesh->triangles.empty()) {
      notes_.push_back({shape.place, name_of(shape), "left out", "it has no triangles"});
      return;
    }
    note_lacking_uvs(shape);
    const std::size_t material =
        materials_.index(shape.material, shape.radiance, shape.emits_behind);
    const auto [found, added] = meshes_.try_emplace({shape.mesh.get(), shape.flipped, material}, 0);
    if (added) {
      OrderedJson primitive = geometry(*shape.mesh, shape.flipped);
      primitive["material"] = material;
      found->second =
          document_.add("meshes", {{"name", name_of(shape)}, {"primitives", {primitive}}});
    }
    OrderedJson node;
    if (!shape.name.empty()) node["name"] = shape.name;
    node["mesh"] = found->second;
    if (shape.to_world != M44d()) node["matrix"] = gltf_matrix(shape.to_world);
    document_.add_node(std::move(node));
  }

  void add(const ImportedLight& light) {
    const float strength = max_component(light.intensity);
    OrderedJson json = {{"type", light.kind == ImportedLight::Kind::point         ? "point"
                                 : light.kind == ImportedLight::Kind::directional ? "directional"
                                                                                  : "spot"}};
    if (!light.name.empty()) json["name"] = light.name;
    json["color"] = gltf_color(strength > 0 ? light.intensity / strength : Rgb(1, 1, 1));
    json["intensity"] = strength;
    if (light.kind == ImportedLight::Kind::spot) {
      json["spot"] = {{"innerConeAngle", light.inner_cone}, {"outerConeAngle", light.outer_cone}};
    }
    const std::size_t index = lights_.size();
    lights_.push_back(std::move(json));
    // A frame whose -z is the light's direction.
    const V3d z = -light.direction.normalized(),
              x = z.cross(std::abs(z.x) < .6 ? V3d(1, 0, 0) : V3d(0, 1, 0)).normalized(),
              y = z.cross(x);
    const V3d p = light.kind == ImportedLight::Kind::directional ? V3d(0, 0, 0) : light.position;
    const M44d to_world(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, p.x, p.y, p.z, 1);
    document_.add_node({{"name", light.name.empty() ? "light" : light.name},
                        {"matrix", gltf_matrix(to_world)},
                        {"extensions", {{"KHR_lights_punctual", {{"light", index}}}}}});
  }

  void add(const ImportedCamera& camera) {
    OrderedJson json = {{"name", camera.name}};
    if (camera.projection == Projection::orthographic) {
      const double across =
          camera.height * scene_.picture.resolution[0] / scene_.picture.resolution[1];
      json["type"] = "orthographic";
      json["orthographic"] = {
          {"xmag", across / 2}, {"ymag", camera.height / 2}, {"znear", 0}, {"zfar", 1e6}};
    } else if (camera.projection == Projection::perspective) {
      json["type"] = "perspective";
      json["perspective"] = {{"yfov", camera.yfov}, {"znear", .01}};
    } else {
      return;  // the job's camera object alone can say it
    }
    const std::size_t index = document_.add("cameras", std::move(json));
    document_.add_node(
        {{"name", camera.name}, {"camera", index}, {"matrix", gltf_matrix(camera.to_world)}});
  }

  void name_extensions() {
    OrderedJson& json = document_.json();
    if (!lights_.empty()) json["extensions"]["KHR_lights_punctual"]["lights"] = lights_;
    std::set<std::string> used;
    if (!lights_.empty()) used.insert("KHR_lights_punctual");
    find_extensions(json["materials"], used);
    if (!used.empty()) json["extensionsUsed"] = used;
    for (const char* list : {"materials", "meshes"}) {
      if (json[list].is_null()) json.erase(list);
    }
  }
  static void find_extensions(const OrderedJson& json, std::set<std::string>& used) {
    if (!json.is_structured()) return;
    for (const auto& [key, value] : json.items()) {
      if (key == "extensions") {
        for (const auto& extension : value.items()) used.insert(extension.key());
      }
      find_extensions(value, used);
    }
  }

  const ImportedScene& scene_;
  std::vector<ImportNote>& notes_;
  GlbDocument document_{"lacuna import"};
  ImportedTextures textures_;
  ImportedMaterials materials_;
  std::map<std::pair<const ImportedMesh*, bool>, OrderedJson> geometries_;
  std::map<std::tuple<const ImportedMesh*, bool, std::size_t>, std::size_t> meshes_;
  OrderedJson lights_ = OrderedJson::array();
};

}  // namespace

std::vector<ImportNote> write_imported_scene(const ImportedScene& scene,
                                             const std::filesystem::path& folder) {
  std::vector<ImportNote> notes = scene.notes;
  if (scene.cameras.empty()) throw SceneError("the file has no camera");
  std::filesystem::create_directories(folder);
  write_file_atomically(folder / "scene.glb", SceneWriter(scene, folder, notes).glb());
  std::optional<WrittenEnvironment> environment;
  if (scene.environment) environment = write_environment(*scene.environment, folder, notes);
  write_job_of(scene, environment, folder, notes);
  return notes;
}

}  // namespace lacuna
