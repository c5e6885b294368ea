#include "renderer/materials/interface.h"

#include "renderer/materials/lobes.h"

namespace lacuna {

Interface::Interface(const SurfaceParams& params)
    : alpha(params.alpha < ggx_min_alpha ? 0 : params.alpha), ior(params.ior) {
  const float dielectric = 1 - params.metallic;
  const float opaque = dielectric * (1 - params.transmission);
  r0 = params.metallic * params.base_color + opaque * params.f0;
  r90 = params.metallic + opaque * params.f90;
  glass = dielectric * params.transmission;
  if (glass > 0) {
    glass_color = glass * params.base_color;
    glass_f0 = params.f0;
    glass_f90 = params.f90;
    exact_f0_ = normal_reflectance(ior);
    inv_range_ = (ior + 1) * (ior + 1) / (4 * ior);
  }
}

}  // namespace lacuna
