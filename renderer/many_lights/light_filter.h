#pragma once

#include <vector>

#include "renderer/many_lights/vpl_contributions.h"
#include "renderer/path/contexts.h"
#include "renderer/settings/gather_settings.h"

namespace lacuna {

/// Mixes what virtual lights give to neighbouring pixels whose surfaces are alike (cross-bilateral
/// filter; Kol et al. 2018, 5.1): without what the surface itself reflects, so that textures stay.
class LightFilter {
 public:
  LightFilter(const Image& image, const RandomLightsSettings& settings);

  /// What some lights give to a pixel by its shading point, which is one for all of them. Different
  /// pixels may be added to by several threads.
  void add(const ShadingPoint& point, const V3d& light);
  /// The filtered light of a pixel; that of one without a shading point is 0.
  V3d at(V2i pixel) const;

 private:
  struct Pixel {
    V3f x, n;            // of the surface; n 0: there is none
    V3f reflected;       // of the light that arrives, with the path's throughput
    V3d light{0, 0, 0};  // over that
  };
  float weight(const Pixel& middle, const Pixel& other) const;

  int width_, height_;
  RandomLightsSettings settings_;
  std::vector<Pixel> pixels_;
};

}  // namespace lacuna
