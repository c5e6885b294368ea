#pragma once

#include <vector>

#include "renderer/core/inversion_table.h"
#include "renderer/core/rng.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// An environment light at infinity, given by an equirectangular image: bilinear, y up, centre
/// column along -z. Directions are sampled by row, then texel, which preserves stratification. The
/// weight of a texel is the exact integral of the bilinear radiance over it, times its row's solid
/// angle, so every direction with radiance has a density above 0.
class Environment {
 public:
  /// `rgb`: width x height x 3 radiances, top row first, finite and >= 0. `rotation` in radians,
  /// about y, counter-clockwise from above.
  Environment(int width, int height, std::vector<float> rgb, float scale, float rotation);

  Rgb radiance(const V3f& w) const;  ///< `w` unit
  struct Sample {
    V3f w;      ///< unit, towards the light
    float pdf;  ///< per steradian
  };
  Sample sample(const Rng::FinePoint& at) const;
  float pdf(const V3f& w) const;  ///< per steradian
  bool black() const { return rows_.empty(); }
  /// Integral of luminance over the sphere.
  double integral() const { return integral_; }

 private:
  V2f to_image(const V3f& w) const;  // texels, texel centres at half-integers
  Rgb texel(int x, int y) const;
  double texel_solid_angle(int y) const;
  float pdf(std::uint32_t x, std::uint32_t y) const;

  int width_, height_;
  std::vector<float> rgb_;
  float scale_;
  float cos_rotation_, sin_rotation_;
  double integral_ = 0;
  InversionTable rows_;
  std::vector<InversionTable> texels_;  // of each row
};

}  // namespace lacuna
