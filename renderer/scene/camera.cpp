#include "renderer/scene/camera.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "renderer/core/sampling.h"
#include "renderer/materials/disk.h"

namespace lacuna {

const CameraData& choose_camera(const SceneData& scene, const std::string& name,
                                const std::string& file) {
  if (scene.cameras.empty()) {
    throw SceneError(
        fmt::format("scene \"{}\" has no camera; the job's camera object defines one: "
                    "{{\"position\": [x, y, z], "
                    "\"target\": [x, y, z]}}",
                    file));
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

namespace {

double distance_to_target(const CameraSettings& s) {
  const V3d position(s.position[0], s.position[1], s.position[2]);
  return (V3d(s.target[0], s.target[1], s.target[2]) - position).length();
}

}  // namespace

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
  data.projection = s.type;
  data.height = s.height;
  data.aperture = s.aperture;
  data.focus = s.focus > 0 ? s.focus : distance_to_target(s);
  data.blades = s.blades;
  return data;
}

Camera::Camera(const CameraData& data, int width, int height, PixelFilter filter,
               const std::optional<Crop>& crop)
    : width_(width),
      height_(height),
      filter_(data.projection == Projection::panorama ? PixelFilter::box : filter),
      projection_(data.projection),
      aperture_(data.projection == Projection::perspective ? data.aperture : 0),
      focus_(data.focus),
      blades_(data.blades) {
  const M44d& m = data.to_world;
  right_ = V3d(m[0][0], m[0][1], m[0][2]);
  up_ = V3d(m[1][0], m[1][1], m[1][2]);
  back_ = V3d(m[2][0], m[2][1], m[2][2]);
  position_ = V3f(V3d(m[3][0], m[3][1], m[3][2]));
  forward_ = V3f(-back_);
  const double half_height = parallel() ? data.height / 2 : std::tan(data.yfov / 2);
  const Crop film = crop.value_or(Crop{.size = {width, height}});
  pixel_ = 2 * half_height / film.size.y;
  dx_ = right_ * pixel_;
  dy_ = up_ * -pixel_;
  const V3d ahead = parallel() ? V3d(0.0) : -back_;
  origin_ = ahead + up_ * half_height - right_ * (pixel_ * film.size.x / 2) +
            dx_ * double(film.first.x) + dy_ * double(film.first.y);
  whole_ = V2f(film.size);
  first_ = V2f(film.first);
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

V3f Camera::lens_point(const V2f& u) const {
  V2f at = sample_disk(u);
  if (blades_ > 0) {
    // A triangle of the centre and two corners, and a point in it.
    const float part = u.x * static_cast<float>(blades_);
    const int corner = std::min(static_cast<int>(part), blades_ - 1);
    const double step = 2 * std::numbers::pi / blades_;
    const auto corner_at = [&](int i) {
      const double angle = std::numbers::pi / 2 + step * i;
      return V2f(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
    };
    const V2f b = sample_triangle({part - static_cast<float>(corner), u.y});
    at = b.x * corner_at(corner) + b.y * corner_at(corner + 1);
  }
  return V3f(V3d(position_) + (right_ * double(at.x) + up_ * double(at.y)) * aperture_);
}

Ray Camera::through(const V3f& eye, const V3f& d) const {
  const V3d sharp = V3d(d) * (focus_ / -back_.dot(V3d(d)));
  return {eye, V3f((sharp - (V3d(eye) - V3d(position_))).normalized())};
}

Pdf<SolidAngle> Camera::density(const V3f& w) const {
  if (parallel()) return Pdf<SolidAngle>(static_cast<float>(1 / (pixel_ * pixel_)));
  if (projection_ == Projection::panorama) {
    // dw = sin(theta) dtheta dphi.
    constexpr double least = 1e-6;  // sine, at the poles
    const double up = up_.dot(V3d(w));
    const double sine = std::sqrt(std::max(1 - up * up, least * least));
    return Pdf<SolidAngle>(static_cast<float>(double(whole_.x) * double(whole_.y) /
                                              (2 * std::numbers::pi * std::numbers::pi * sine)));
  }
  // dA = dw / cos^3 on a plane at unit distance.
  const double c = double(dot(w, forward_));
  return Pdf<SolidAngle>(static_cast<float>(1 / (pixel_ * pixel_ * c * c * c)));
}

V2f Camera::film_of_panorama(const V3f& w) const {
  const V3d d(w);
  const double phi = std::atan2(d.dot(right_), -d.dot(back_));  // 0 in the middle, to the right
  const double theta = std::acos(std::clamp(d.dot(up_), -1.0, 1.0));
  const V2f whole(static_cast<float>((phi / (2 * std::numbers::pi) + 0.5) * double(whole_.x)),
                  static_cast<float>(theta / std::numbers::pi * double(whole_.y)));
  return whole - first_;
}

std::optional<V2f> Camera::project(const V3f& eye, const V3f& w) const {
  V2f at;
  if (projection_ == Projection::panorama) {
    at = film_of_panorama(w);
  } else {
    const double c = double(dot(w, forward_));
    if (!(c > 0)) return std::nullopt;
    const V3d from_centre = V3d(eye) - V3d(position_);
    V3d on_film = parallel() ? from_centre : V3d(w) / c;
    if (has_lens()) on_film += from_centre / focus_;
    on_film -= origin_;
    const double square = pixel_ * pixel_;
    at = V2f(static_cast<float>(on_film.dot(dx_) / square),
             static_cast<float>(on_film.dot(dy_) / square));
  }
  const bool seen = at.x >= -margin() && at.y >= -margin() &&
                    at.x < static_cast<float>(width_) + margin() &&
                    at.y < static_cast<float>(height_) + margin();
  return seen ? std::optional(at) : std::nullopt;
}

Ray Camera::ray(float x, float y) const {
  if (projection_ == Projection::panorama) {
    const double phi =
        ((double(x) + double(first_.x)) / double(whole_.x) - 0.5) * 2 * std::numbers::pi;
    const double theta = (double(y) + double(first_.y)) / double(whole_.y) * std::numbers::pi;
    const V3d around = right_ * std::sin(phi) - back_ * std::cos(phi);
    const V3d d = around * std::sin(theta) + up_ * std::cos(theta);
    return {position_, V3f(d.normalized())};
  }
  const V3d d = origin_ + dx_ * double(x) + dy_ * double(y);
  if (parallel()) return {V3f(V3d(position_) + d), forward_};
  return {position_, V3f(d.normalized())};
}

}  // namespace lacuna
