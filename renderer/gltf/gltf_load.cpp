#include <nlohmann/json.hpp>

#include "renderer/gltf/gltf_cameras.h"
#include "renderer/gltf/gltf_geometry.h"
#include "renderer/gltf/gltf_guard.h"
#include "renderer/gltf/gltf_load.h"
#include "renderer/gltf/gltf_materials.h"
#include "renderer/gltf/gltf_nodes.h"
#include "renderer/gltf/gltf_origin.h"
#include "renderer/gltf/gltf_skins.h"

namespace lacuna {
namespace gltf {
namespace {

void warn_of_unread_parts(const GltfObject& root, Warnings& warnings) {
  if (root.array_size("animations") > 0) {
    warnings.once("animations are left out: the scene stands still in its rest pose");
  }
  for (const std::string& name : root.strings("extensionsUsed")) {
    if (!extension_supported(name)) warnings.once(unsupported_extension(name));
  }
}

SceneData load(const std::filesystem::path& file, std::vector<InputFile>* inputs) {
  SceneFolder folder(file);
  const Bytes bytes = folder.read_main();
  const Framing framing = check_framing(bytes);
  const Json json = parse_json(framing.json);
  Warnings warnings;
  GltfProblems problems(json, warnings);
  const GltfObject root(json, problems);
  check_structure(root, framing);

  SceneData scene;
  TextureTable textures(root, warnings);
  scene.materials = read_materials(root, textures, warnings);
  const auto nodes = place_nodes(root, {}, warnings);
  const auto place_cameras_and_lights = [&] {
    scene.cameras = read_cameras(root, nodes, scene.origin, warnings);
    scene.lights = read_lights(root, nodes, scene.origin, warnings);
  };
  place_cameras_and_lights();  // their faults are told before buffers are read

  Hasher content;
  content.add(std::span<const std::uint8_t>(bytes));
  const file::Model model = read_model(framing, root, folder, content);
  const Skins skins = pose_skins(root, model, nodes, node_transforms(root, {}));
  build_meshes(model, nodes, skins, scene, warnings);
  if (scene.origin != V3d(0.0)) place_cameras_and_lights();
  warn_of_far_cameras(scene, warnings);
  scene.textures = textures.build(model, folder, content);
  scene.content_hash = content.digest();
  if (inputs != nullptr) *inputs = folder.inputs();
  warn_of_unread_parts(root, warnings);
  scene.warnings = warnings.take();
  return scene;
}

}  // namespace
}  // namespace gltf

SceneData load_gltf(const std::filesystem::path& file, std::vector<InputFile>* inputs) {
  try {
    return gltf::load(file, inputs);
  } catch (const SceneError& e) {
    throw SceneError(file.string() + ": " + e.what());
  }
}

}  // namespace lacuna
