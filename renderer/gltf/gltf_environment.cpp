#include "renderer/gltf/gltf_environment.h"

#include <cmath>

#include "renderer/gltf/gltf_transforms.h"

namespace lacuna::gltf {
namespace {

constexpr std::string_view environment_extension = "EXT_lights_image_based";

/// The environment made of a cube takes 384 bytes for each texel of a face: 2 GiB at most,
/// as textures.
constexpr std::uint64_t longest_side = 2048;

EnvironmentCube read_cube(const GltfObject& light, std::size_t images, TextureTable& textures) {
  EnvironmentCube cube;
  cube.side = static_cast<int>(light.integer("specularImageSize", 1, longest_side));
  cube.intensity = static_cast<float>(light.number("intensity", 1, non_negative));
  constexpr float brightest = 1e12F;  // as of a job's environment
  if (cube.intensity > brightest) light.refuse("intensity", "a number from 0 to 1e12");
  if (const auto q = light.numbers<4>("rotation", Limits{})) {
    const double length = std::hypot(std::hypot((*q)[0], (*q)[1]), std::hypot((*q)[2], (*q)[3]));
    if (!(std::abs(length - 1) <= hair)) light.refuse("rotation", "a quaternion of length 1");
    cube.to_world = transform_of({1, 1, 1}, *q, {0, 0, 0});
  }
  const auto levels = light.index_lists("specularImages", images, "images");
  if (levels.empty()) light.fail("specularImages is missing or empty");
  for (const auto& faces : levels) {
    if (faces.size() != 6) light.refuse("specularImages", "lists of 6 images, one for each face");
  }
  for (std::size_t f = 0; f < 6; ++f) {
    cube.faces[f] = textures.clamped(levels[0][f], Texture::Encoding::srgb);
  }
  return cube;
}

}  // namespace

std::optional<EnvironmentCube> read_environment(const GltfObject& root, TextureTable& textures) {
  const auto scenes = root.objects("scenes");
  if (scenes.empty()) return std::nullopt;
  const std::size_t scene = root.index("scene", scenes.size(), "scenes").value_or(0);
  const auto named = scenes[scene].extension(environment_extension);
  if (!named) return std::nullopt;
  const auto all = root.extension(environment_extension);
  const auto lights = all ? all->objects("lights") : std::vector<GltfObject>{};
  const auto light = named->index("light", lights.size(), "EXT_lights_image_based.lights");
  if (!light) named->fail("light is missing: an index");
  return read_cube(lights[*light], root.array_size("images"), textures);
}

}  // namespace lacuna::gltf
