#pragma once

#include "renderer/scene/rays.h"
#include "renderer/scene/scene_data.h"
#include "renderer/settings/output_settings.h"

namespace lacuna {

/// The camera called `name` (empty: the first). `file` names the scene in errors. Throws
/// SceneError: there is none of that name, or none at all.
const CameraData& choose_camera(const SceneData& scene, const std::string& name,
                                const std::string& file);

/// A pinhole camera with a film of `width` x `height` square pixels; the vertical field of view is
/// the glTF camera's, the horizontal one follows from the film.
class Camera {
 public:
  Camera(const CameraData& data, int width, int height, PixelFilter filter = PixelFilter::box);

  /// The ray of a sample of `pixel`, for `u` uniform in [0, 1)^2. The point on the film is drawn
  /// from the pixel filter itself, so all samples count alike and pixels stay independent (Ernst,
  /// Stamminger and Greiner 2006, "Filter Importance Sampling").
  Ray sample(const V2i& pixel, const V2f& u) const;

  /// The ray through film position (x, y), in pixels from the upper left corner. `d` is unit.
  Ray ray(float x, float y) const;

  const V3f& position() const { return position_; }
  const V3f& forward() const { return forward_; }

 private:
  V3f position_;
  V3f forward_;
  PixelFilter filter_;
  V3d origin_, dx_, dy_;  // the film plane at unit distance: origin_ + x dx_ + y dy_
};

}  // namespace lacuna
