#pragma once

#include <optional>

#include "renderer/core/density.h"
#include "renderer/core/rng.h"
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

/// A camera with a film of `width` x `height` square pixels. The vertical extent of its view is
/// that of CameraData; the horizontal one follows from the film, but for a panorama, which is of
/// all directions.
///
/// Rays start at the eye: a point; with a lens a point on it, uniformly distributed, whose density
/// cancels in all ratios because every method samples it alike; in a parallel projection a point on
/// the plane of the camera, which is the eye at infinity as a directional light is an emitter
/// there: densities of directions are then per area across the view.
class Camera {
 public:
  /// With `crop`, the film is that part of a larger picture of the same view. Pixels of a panorama
  /// are boxes: those of another filter would overlap at the poles.
  Camera(const CameraData& data, int width, int height, PixelFilter filter = PixelFilter::box,
         const std::optional<Crop>& crop = {});

  /// The ray of a sample of `pixel`, for `u` uniform in [0, 1)^2. The film position is sampled from
  /// the pixel filter, so all samples have equal weight and pixels are independent (Ernst,
  /// Stamminger and Greiner 2006, "Filter Importance Sampling"). From the centre of the lens.
  Ray sample(const V2i& pixel, const V2f& u) const;
  /// The same from a point on the lens that `rng` chooses.
  Ray sample(const V2i& pixel, const V2f& u, Rng& rng) const {
    const Ray centre = sample(pixel, u);
    return has_lens() ? through(lens_point(lens_numbers(rng)), centre.d) : centre;
  }

  /// The ray through film position (x, y), in pixels from the upper left corner, from the centre of
  /// the lens. `d` is unit.
  Ray ray(float x, float y) const;
  /// The same from the point `eye` of the lens.
  Ray ray(float x, float y, const V3f& eye) const {
    const Ray centre = ray(x, y);
    return has_lens() ? through(eye, centre.d) : centre;
  }

  /// Density, at unit `w` in front of the camera, of one sample per pixel, uniform over the film:
  /// the number of pixels per steradian, or of a parallel projection per area across the view. It
  /// is also the importance of the eye: a light path connected to the eye contributes its radiance
  /// times density() times the weights of splat(). The same from all points of a lens: where the
  /// plane in focus is seen at distance d = focus / cos, a pixel covers d^2 / cos of it.
  Pdf<SolidAngle> density(const V3f& w) const;

  /// The film position, in pixels, of light that arrives at the point `eye` from unit `w` (away
  /// from the eye); none outside the film.
  std::optional<V2f> project(const V3f& eye, const V3f& w) const;
  /// The same at position().
  std::optional<V2f> project(const V3f& w) const { return project(position_, w); }

  /// The point of the eye from which `x` is seen: the centre of the lens, or in a parallel
  /// projection the foot of `x` on the plane of the camera.
  V3f eye(const V3f& x) const {
    if (!parallel()) return position_;
    const V3d from_plane = V3d(x) - V3d(position_);
    return V3f(V3d(x) - back_ * from_plane.dot(back_));
  }
  /// The same from the point of the lens that `lens` chooses (lens_numbers()).
  V3f eye(const V3f& x, const V2f& lens) const { return has_lens() ? lens_point(lens) : eye(x); }
  /// Uniform in [0, 1)^2, to choose a point of the lens; draws nothing without a lens.
  V2f lens_numbers(Rng& rng) const { return has_lens() ? rng.next2() : V2f(0, 0); }
  bool has_lens() const { return aperture_ > 0; }
  /// Whether all rays are parallel: the eye is at infinity.
  bool parallel() const { return projection_ == Projection::orthographic; }
  /// Side, in scene units, of what a pixel sees at that distance along unit `w`.
  double pixel_side(const V3f& w, double distance) const {
    return (parallel() ? 1 : distance) / std::sqrt(double(density(w).value));
  }

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
  /// The centre of the lens, or the middle of a parallel projection's film.
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

  /// A point of the lens, uniformly distributed.
  V3f lens_point(const V2f& u) const;
  /// The ray from `eye`, on the lens, to where the ray along `d` from its centre is in focus.
  Ray through(const V3f& eye, const V3f& d) const;
  V2f film_of_panorama(const V3f& w) const;

  int width_, height_;
  V3f position_;
  V3f forward_;
  PixelFilter filter_;
  Projection projection_;
  double aperture_, focus_;
  int blades_;
  V3d right_, up_, back_;  // unit axes
  /// Perspective: side of a pixel on the film plane at unit distance; orthographic: scene units.
  double pixel_;
  /// Perspective: the film plane at unit distance, origin_ + x dx_ + y dy_, from the eye;
  /// orthographic: the plane of the camera, from position_.
  V3d origin_, dx_, dy_;
  V2f whole_, first_;  // panorama: size of the whole picture, and where the film begins, pixels
};

}  // namespace lacuna
