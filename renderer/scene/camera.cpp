#include "renderer/scene/camera.h"

namespace lacuna {

Camera::Camera(const CameraData& data, int width, int height) {
  const M44d& m = data.to_world;
  const V3d right(m[0][0], m[0][1], m[0][2]);
  const V3d up(m[1][0], m[1][1], m[1][2]);
  const V3d back(m[2][0], m[2][1], m[2][2]);
  position_ = V3f(V3d(m[3][0], m[3][1], m[3][2]));
  forward_ = V3f(-back);
  const double half_height = std::tan(data.yfov / 2);
  const double pixel = 2 * half_height / height;
  dx_ = right * pixel;
  dy_ = up * -pixel;
  origin_ = -back + up * half_height - right * (pixel * width / 2);
}

Ray Camera::ray(float x, float y) const {
  const V3d d = origin_ + dx_ * double(x) + dy_ * double(y);
  return {position_, V3f(d.normalized())};
}

}  // namespace lacuna
