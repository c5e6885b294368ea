#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <array>
#include <optional>

#include "base/settings/field.h"

namespace lacuna {

/// A camera defined by the job, in the coordinates of the scene's file.
struct CameraSettings {
  std::array<double, 3> position{0, 0, 0};
  std::array<double, 3> target{0, 0, -1};
  std::array<double, 3> up{0, 1, 0};
  double fov = 45;
  bool operator==(const CameraSettings&) const = default;
};
template <class V>
void describe(V& v, CameraSettings& s) {
  v("position", s.position,
    {.doc = "position of the camera, in the coordinates of the scene's file",
     .min = -1e15,
     .max = 1e15,
     .required = true});
  v("target", s.target,
    {.doc = "the point at the centre of the picture", .min = -1e15, .max = 1e15, .required = true});
  v("up", s.up,
    {.doc = "a direction that points up in the picture, not parallel to the view direction",
     .min = -1e15,
     .max = 1e15});
  v("fov", s.fov, {.doc = "vertical field of view", .min = 0.01, .max = 179, .unit = "degrees"});
}

/// The unit axes of a camera: right, up, and opposite to the view direction.
struct CameraFrame {
  Imath::V3d right, up, back;
};

/// None if position and target coincide, or if `up` is 0 or parallel to the view direction.
inline std::optional<CameraFrame> frame_of(const CameraSettings& s) {
  const auto vector = [](const std::array<double, 3>& v) { return Imath::V3d(v[0], v[1], v[2]); };
  const Imath::V3d position = vector(s.position), target = vector(s.target);
  const Imath::V3d back = position - target;
  // The spacing of doubles at these coordinates, approximately.
  const double grain = 0x1p-50 * std::max(position.length(), target.length());
  if (!(back.length() > grain)) return {};
  CameraFrame f;
  f.back = back.normalized();
  const Imath::V3d right = vector(s.up).normalized().cross(f.back);
  if (!(right.length() > 1e-9)) return {};
  f.right = right.normalized();
  f.up = f.back.cross(f.right);
  return f;
}

}  // namespace lacuna
