#pragma once

#include "renderer/scene/rays.h"
#include "renderer/scene/scene_data.h"

namespace lacuna {

/// A pinhole camera with a film of `width` x `height` square pixels; the vertical field of view is
/// the glTF camera's, the horizontal one follows from the film.
class Camera {
 public:
  Camera(const CameraData& data, int width, int height);

  /// The ray through film position (x, y), in pixels from the upper left corner. `d` is unit.
  Ray ray(float x, float y) const;

  const V3f& position() const { return position_; }
  const V3f& forward() const { return forward_; }

 private:
  V3f position_;
  V3f forward_;
  V3d origin_, dx_, dy_;  // the film plane at unit distance: origin_ + x dx_ + y dy_
};

}  // namespace lacuna
