#include "renderer/materials/interface.h"

#include "renderer/materials/lobes.h"

namespace lacuna {

Interface::Interface(const SurfaceParams& params)
    : alpha(params.alpha < ggx_min_alpha ? 0 : params.alpha), ior(params.ior), film(params.film) {
  const float dielectric = 1 - params.metallic;
  const float opaque = dielectric * (1 - params.transmission);
  r0 = params.metallic * params.base_color + opaque * params.f0;
  r90 = params.metallic + opaque * params.f90;
  glass = dielectric * params.transmission;
  if (glass > 0) {
    thin = !params.solid;
    glass_color = glass * params.base_color;
    glass_f0 = params.f0;
    glass_f90 = params.f90;
    exact_f0_ = normal_reflectance(ior);
    inv_range_ = (ior + 1) * (ior + 1) / (4 * ior);
  }
  if (film.strength > 0) {
    metallic_ = params.metallic;
    opaque_ = opaque;
    f90_ = params.f90;
    metal_f0_ = params.base_color;
    f0_ = params.f0;
  }
}

void Interface::add_film(float outside, Split& of) const {
  const float bare = 1 - film.strength;
  of.reflected *= bare;
  of.transmitted *= bare;
  if (metallic_ > 0) {
    of.reflected += (film.strength * metallic_) * film.reflectance(outside, metal_f0_);
  }
  if (metallic_ == 1) return;
  const Rgb f = f90_ * film.reflectance(outside, f0_);
  of.reflected += (film.strength * (opaque_ + glass)) * f;
  of.transmitted += (film.strength * (1 - max_component(f))) * glass_color;
}

}  // namespace lacuna
