#include "renderer/scene/points_in_surfaces.h"

#include <fmt/format.h>

namespace lacuna {

namespace {

const std::string& mesh_name(const Scene& scene, const SurfaceContact& contact) {
  return scene.data().meshes[contact.planes[0].mesh].name;
}

}  // namespace

std::vector<std::string> lights_in_surfaces(const Scene& scene) {
  std::size_t count = 0;
  const PunctualLight* first = nullptr;
  for (const PunctualLight& light : scene.data().lights) {
    if (light.contact == nullptr) continue;
    if (count++ == 0) first = &light;
  }
  if (count == 0) return {};
  return {fmt::format(
      "{} of {} lights lie exactly in a surface, the first, \"{}\", in mesh \"{}\": they light "
      "both of its sides, but not the surface itself; move them off it",
      count, scene.data().lights.size(), first->name, mesh_name(scene, *first->contact))};
}

std::optional<SurfaceContact> leave_surfaces(CameraData& camera, const Scene& scene) {
  M44d& m = camera.to_world;
  const V3d position(m[3][0], m[3][1], m[3][2]);
  const auto contact = scene.find_contact(V3f(position));
  if (!contact) return std::nullopt;
  const V3d forward(-m[2][0], -m[2][1], -m[2][2]);
  const V3f moved = contact->origin(V3f(position), V3f(forward));
  for (int k = 0; k < 3; ++k) m[3][k] = double(moved[k]);
  return contact;
}

std::vector<std::string> look_back(const Camera& camera, const SurfaceContact& left,
                                   const Scene& scene) {
  for (int i = 0; i < left.count; ++i) {
    const V3f& n = left.planes[static_cast<std::size_t>(i)].ng;
    const float side = std::copysign(1.0F, dot(camera.forward(), n));
    for (const float x : {0.0F, static_cast<float>(camera.width())}) {
      for (const float y : {0.0F, static_cast<float>(camera.height())}) {
        if (dot(camera.ray(x, y).d, n) * side >= 0) continue;
        return {fmt::format(
            "the camera lies exactly in mesh \"{}\" and looks along its plane: part of the picture "
            "shows only that surface, from almost no distance; move the camera off it",
            mesh_name(scene, left))};
      }
    }
  }
  return {};
}

}  // namespace lacuna
