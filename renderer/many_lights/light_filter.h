#pragma once

#include <vector>

#include "renderer/many_lights/vpl_contributions.h"
#include "renderer/path/contexts.h"
#include "renderer/settings/gather_settings.h"

namespace lacuna {

/// Averages the light of the virtual lights over neighbouring pixels with similar surfaces
/// (cross-bilateral filter; Kol et al. 2018, 5.1). The light is first divided by the surface's
/// reflectance, so that textures stay sharp.
class LightFilter {
 public:
  LightFilter(const Image& image, const RandomLightsSettings& settings);

  /// Adds light to the pixel of `point`, the only shading point of the pixel. Different pixels may
  /// be changed by several threads at once.
  void add(const ShadingPoint& point, const V3d& light);
  /// The filtered light of a pixel; 0 if it has no shading point.
  V3d at(V2i pixel) const;

 private:
  struct Pixel {
    V3f x, n;            // of the surface; n = 0: no shading point
    V3f reflected;       // reflectance times the path's throughput
    V3d light{0, 0, 0};  // contribution over `reflected`
  };
  float weight(const Pixel& middle, const Pixel& other) const;

  int width_, height_;
  RandomLightsSettings settings_;
  std::vector<Pixel> pixels_;
};

}  // namespace lacuna
