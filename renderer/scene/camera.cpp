#include "renderer/scene/camera.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lacuna {

const CameraData& choose_camera(const SceneData& scene, const std::string& name,
                                const std::string& file) {
  if (scene.cameras.empty()) {
    throw SceneError(fmt::format("scene \"{}\" has no perspective camera; it needs one", file));
  }
  if (name.empty()) return scene.cameras.front();
  for (const auto called : {&CameraData::name, &CameraData::node}) {
    const auto found = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                    [&](const CameraData& c) { return c.*called == name; });
    if (found != scene.cameras.end()) return *found;
  }
  std::vector<std::string> names;
  for (const CameraData& c : scene.cameras) names.push_back(fmt::format("\"{}\"", c.name));
  throw SceneError(fmt::format("scene \"{}\" has no camera \"{}\"; it has {}", file, name,
                               fmt::join(names, ", ")));
}

CameraData look_at(const CameraSettings& s, const V3d& origin) {
  const auto frame = frame_of(s);
  if (!frame) {
    throw std::invalid_argument(
        "the camera's target is its position, or up is parallel to the view direction");
  }
  const auto& [x, y, z] = *frame;
  const V3d p = V3d(s.position[0], s.position[1], s.position[2]) - origin;
  CameraData data;
  data.to_world = M44d(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, p.x, p.y, p.z, 1);
  data.yfov = s.fov * std::numbers::pi / 180;
  return data;
}

Camera::Camera(const CameraData& data, int width, int height, PixelFilter filter,
               const std::optional<Crop>& crop)
    : width_(width), height_(height), filter_(filter) {
  const M44d& m = data.to_world;
  const V3d right(m[0][0], m[0][1], m[0][2]);
  const V3d up(m[1][0], m[1][1], m[1][2]);
  const V3d back(m[2][0], m[2][1], m[2][2]);
  position_ = V3f(V3d(m[3][0], m[3][1], m[3][2]));
  forward_ = V3f(-back);
  const double half_height = std::tan(data.yfov / 2);
  const Crop film = crop.value_or(Crop{.size = {width, height}});
  pixel_ = 2 * half_height / film.size.y;
  dx_ = right * pixel_;
  dy_ = up * -pixel_;
  origin_ = -back + up * half_height - right * (pixel_ * film.size.x / 2) +
            dx_ * double(film.first.x) + dy_ * double(film.first.y);
}

Ray Camera::sample(const V2i& pixel, const V2f& u) const {
  // Relative to the pixel's upper left corner: the box ends at the pixel's edges, the tent one
  // pixel from its centre.
  const auto place = [&](float x) {
    if (filter_ == PixelFilter::box) return x;
    return x < 0.5F ? std::sqrt(2 * x) - 0.5F : 1.5F - std::sqrt(2 * (1 - x));
  };
  return ray(static_cast<float>(pixel.x) + place(u.x), static_cast<float>(pixel.y) + place(u.y));
}

Pdf<SolidAngle> Camera::density(const V3f& w) const {
  // dA = dw / cos^3 on a plane at unit distance.
  const double c = double(dot(w, forward_));
  return Pdf<SolidAngle>(static_cast<float>(1 / (pixel_ * pixel_ * c * c * c)));
}

std::optional<V2f> Camera::project(const V3f& w) const {
  const double c = double(dot(w, forward_));
  if (!(c > 0)) return std::nullopt;
  const V3d on_film = V3d(w) / c - origin_;
  const double square = pixel_ * pixel_;
  const V2f at(static_cast<float>(on_film.dot(dx_) / square),
               static_cast<float>(on_film.dot(dy_) / square));
  const bool seen = at.x >= -margin() && at.y >= -margin() &&
                    at.x < static_cast<float>(width_) + margin() &&
                    at.y < static_cast<float>(height_) + margin();
  return seen ? std::optional(at) : std::nullopt;
}

Ray Camera::ray(float x, float y) const {
  const V3d d = origin_ + dx_ * double(x) + dy_ * double(y);
  return {position_, V3f(d.normalized())};
}

}  // namespace lacuna
