#include <nlohmann/json.hpp>

#include "renderer/gltf/gltf_animation.h"
#include "renderer/gltf/gltf_cameras.h"
#include "renderer/gltf/gltf_environment.h"
#include "renderer/gltf/gltf_features.h"
#include "renderer/gltf/gltf_geometry.h"
#include "renderer/gltf/gltf_guard.h"
#include "renderer/gltf/gltf_instances.h"
#include "renderer/gltf/gltf_load.h"
#include "renderer/gltf/gltf_material_choice.h"
#include "renderer/gltf/gltf_materials.h"
#include "renderer/gltf/gltf_nodes.h"
#include "renderer/gltf/gltf_origin.h"
#include "renderer/gltf/gltf_skins.h"

namespace lacuna {
namespace gltf {
namespace {

void warn_of_unread_parts(const Json& json, const GltfObject& root, const SceneChoice& choice,
                          Warnings& warnings) {
  if (root.array_size("animations") > 0 && !choice.seconds) {
    warnings.once(
        "animations are left out: the scene is in its static pose; the job's time shows "
        "them at a moment");
  }
  if (!choice.animation.empty() && !choice.seconds) {
    warnings.once("animation " + in_quotes(choice.animation) + " is left out, as no time is given");
  }
  root.strings("extensionsUsed");  // are strings
  for (const std::string& name : extensions_of(json)) {
    if (!extension_supported(name)) warnings.once(unsupported_extension(name));
  }
}

/// The data that are hashed in addition to the files' bytes; none if nothing is chosen.
void add_choice(const SceneChoice& choice, Hasher& content) {
  if (choice.seconds) {
    content.add(std::span<const double>(&*choice.seconds, 1));
    content.add(std::span<const char>(choice.animation));
  }
  if (!choice.variant.empty()) content.add(std::span<const char>(choice.variant));
  if (choice.light_units == LightUnits::photometric)
    content.add(std::span<const char>(std::string_view("photometric")));
}

SceneData load(const std::filesystem::path& file, std::vector<InputFile>* inputs,
               const SceneChoice& choice) {
  SceneFolder folder(file);
  Bytes bytes = folder.read_main();
  const Framing framing = check_framing(bytes);
  const Json json = parse_json(framing.json);
  Warnings warnings, unused;
  GltfProblems problems(json, warnings), quiet(json, unused);
  const GltfObject root(json, problems);
  check_structure(root, framing);

  SceneData scene;
  TextureTable textures(root, warnings);
  scene.materials = read_materials(root, textures, warnings);
  scene.environment = read_environment(root, textures);
  std::vector<PlacedNode> nodes;
  const auto place_cameras_and_lights = [&](const GltfObject& from, Warnings& to) {
    scene.cameras = read_cameras(from, nodes, scene.origin);
    scene.lights = read_lights(from, nodes, scene.origin, to);
  };
  {  // Errors in nodes, cameras and lights are reported before buffers are read. Warnings about a
     // static pose that animations replace are suppressed.
    const GltfObject from = choice.seconds ? GltfObject(json, quiet) : root;
    Warnings& to = choice.seconds ? unused : warnings;
    nodes = place_nodes(from, {}, to);
    place_cameras_and_lights(from, to);
  }

  Hasher content;
  content.add(std::span<const std::uint8_t>(bytes));
  file::Model model = read_model(std::move(bytes), framing, json, root, folder, content);
  choose_materials(root, choice.variant, scene.materials.size(), model);
  Pose pose;
  if (choice.seconds) {
    pose = pose_at(root, model, *choice.seconds, choice.animation, warnings);
    nodes = place_nodes(root, pose, warnings);
  }
  add_choice(choice, content);
  const Skins skins = pose_skins(root, model, nodes, node_transforms(root, pose));
  const auto expanded = expand_instances(model, nodes, warnings);
  build_meshes(model, expanded ? *expanded : nodes, skins, scene, warnings);
  if (choice.seconds || scene.origin != V3d(0.0)) place_cameras_and_lights(root, warnings);
  warn_of_far_cameras(scene, warnings);
  convert_lights(root, choice.light_units, scene.lights, warnings);
  scene.textures = textures.build(model, folder, content);
  scene.content_hash = content.digest();
  if (inputs != nullptr) *inputs = folder.inputs();
  warn_of_unread_parts(json, root, choice, warnings);
  scene.warnings = warnings.take();
  return scene;
}

}  // namespace
}  // namespace gltf

SceneData load_gltf(const std::filesystem::path& file, std::vector<InputFile>* inputs,
                    const SceneChoice& choice) {
  try {
    return gltf::load(file, inputs, choice);
  } catch (const SceneError& e) {
    throw SceneError(file.string() + ": " + e.what());
  }
}

}  // namespace lacuna
