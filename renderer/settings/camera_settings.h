#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <array>
#include <optional>

#include "base/settings/field.h"

namespace lacuna {

enum class Projection { perspective, orthographic, panorama };
template <>
struct EnumTable<Projection> {
  static constexpr std::array<EnumValue<Projection>, 3> values{{
      {Projection::perspective, "perspective", "a pinhole, or with `aperture` a thin lens"},
      {Projection::orthographic, "orthographic",
       "parallel rays from a plane through `position`; what lies behind the plane is not seen"},
      {Projection::panorama, "panorama",
       "all directions around `position`, equirectangular: columns are angles around `up`, rows "
       "angles from it; `target` is in the middle; its resolution should be 2 : 1"},
  }};
};

/// A camera defined by the job, in the coordinates of the scene's file.
struct CameraSettings {
  Projection type = Projection::perspective;
  std::array<double, 3> position{0, 0, 0};
  std::array<double, 3> target{0, 0, -1};
  std::array<double, 3> up{0, 1, 0};
  double fov = 45;
  double height = 2;
  double aperture = 0;
  double focus = 0;
  int blades = 0;
  bool operator==(const CameraSettings&) const = default;
};
template <class V>
void describe(V& v, CameraSettings& s) {
  v("type", s.type, {.doc = "how directions become places in the picture"});
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
  v("fov", s.fov,
    {.doc = "vertical field of view, of a perspective camera",
     .min = 0.01,
     .max = 179,
     .unit = "degrees"});
  v("height", s.height,
    {.doc = "height of the picture, of an orthographic camera",
     .min = 0,
     .max = 1e15,
     .above_min = true,
     .unit = "scene units"});
  v("aperture", s.aperture,
    {.doc = "radius of the lens of a perspective camera, for depth of field; of a lens of focal "
            "length f at f-number N it is f / 2N; 0: a pinhole",
     .min = 0,
     .max = 1e12,
     .unit = "scene units"});
  v("focus", s.focus,
    {.doc = "distance of the plane that is sharp, along the view; 0: that of `target`",
     .min = 0,
     .max = 1e15,
     .unit = "scene units"});
  v("blades", s.blades,
    {.doc = "corners of the aperture, a regular polygon of radius `aperture` with one corner up, 3 "
            "or more; 0: it is round",
     .min = 0,
     .max = 64});
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
