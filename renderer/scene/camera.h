#pragma once

#include <optional>

#include "renderer/core/density.h"
#include "renderer/geometry/rays.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/settings/camera_settings.h"
#include "renderer/settings/output_settings.h"

namespace lacuna {

/// The camera of that `name`, or the first if it is empty. `file` names the scene in errors. Throws
/// SceneError if no camera has that name, or if there is none at all.
const CameraData& choose_camera(const SceneData& scene, const std::string& name,
                                const std::string& file);

/// A camera defined by the job, without a name. `origin`: SceneData::origin. Throws
/// std::invalid_argument if it has no frame (frame_of()).
CameraData look_at(const CameraSettings& s, const V3d& origin);

/// The part of a larger picture that a film covers: `size` pixels from pixel `first`.
struct Crop {
  V2i first{0, 0};
  V2i size{0, 0};
};

/// A pinhole camera with a film of `width` x `height` square pixels. The vertical field of view is
/// the glTF camera's; the horizontal one follows from the film.
class Camera {
 public:
  /// With `crop`, the film is that part of a larger picture of the same view.
  Camera(const CameraData& data, int width, int height, PixelFilter filter = PixelFilter::box,
         const std::optional<Crop>& crop = {});

  /// The ray of a sample of `pixel`, for `u` uniform in [0, 1)^2. The film position is sampled from
  /// the pixel filter, so all samples have equal weight and pixels are independent (Ernst,
  /// Stamminger and Greiner 2006, "Filter Importance Sampling").
  Ray sample(const V2i& pixel, const V2f& u) const;

  /// The ray through film position (x, y), in pixels from the upper left corner. `d` is unit.
  Ray ray(float x, float y) const;

  /// Solid-angle density, at unit `w` in front of the camera, of one sample per pixel, uniform over
  /// the film: the number of pixels per steradian. It is also the importance of the eye: a light
  /// path connected to the eye contributes its radiance times density() times the weights of
  /// splat().
  Pdf<SolidAngle> density(const V3f& w) const;

  /// The film position, in pixels, of light that arrives from unit `w` (away from the eye); none
  /// outside the film.
  std::optional<V2f> project(const V3f& w) const;

  /// Calls `pixel(index, weight)` for the pixels whose filter covers film position `at`: index in
  /// the film, top row first, weight > 0. The filter's integral over the film is 1.
  template <class Pixel>
  void splat(const V2f& at, Pixel&& pixel) const {
    if (filter_ == PixelFilter::box) {
      const V2i p(static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y)));
      if (inside(p)) pixel(index(p), 1.0F);
      return;
    }
    const V2i first(static_cast<int>(std::floor(at.x - 0.5F)),
                    static_cast<int>(std::floor(at.y - 0.5F)));
    for (const V2i& p : {first, first + V2i(1, 0), first + V2i(0, 1), first + V2i(1, 1)}) {
      const float weight =
          tent(at.x - static_cast<float>(p.x)) * tent(at.y - static_cast<float>(p.y));
      if (inside(p) && weight > 0) pixel(index(p), weight);
    }
  }

  /// Size of the film, pixels.
  int width() const { return width_; }
  int height() const { return height_; }
  /// The distance, in pixels, to which the filter reaches beyond the film.
  float margin() const { return filter_ == PixelFilter::box ? 0.0F : 0.5F; }
  const V3f& position() const { return position_; }
  const V3f& forward() const { return forward_; }

 private:
  bool inside(const V2i& p) const { return p.x >= 0 && p.y >= 0 && p.x < width_ && p.y < height_; }
  std::uint32_t index(const V2i& p) const {
    return static_cast<std::uint32_t>(p.y) * static_cast<std::uint32_t>(width_) +
           static_cast<std::uint32_t>(p.x);
  }
  /// The tent filter at distance `x` from the pixel's upper left corner.
  static float tent(float x) { return std::max(0.0F, 1 - std::abs(x - 0.5F)); }

  int width_, height_;
  V3f position_;
  V3f forward_;
  PixelFilter filter_;
  double pixel_;          // side of a pixel on the film plane at unit distance
  V3d origin_, dx_, dy_;  // the film plane at unit distance: origin_ + x dx_ + y dy_
};

}  // namespace lacuna
