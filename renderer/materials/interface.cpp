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

Interface::Interface(const ExactSurface& s)
    : alpha(s.roughness.widths().y), ior(s.ior), reflectance_(s.reflectance) {
  using Base = ExactSurface::Base;
  switch (s.base) {
    case Base::gltf:
    case Base::diffuse:
      alpha = 0;
      exact_ = Exact::constant;
      reflectance_ = Rgb(0, 0, 0);
      break;
    case Base::glossy:
      exact_ = Exact::constant;
      break;
    case Base::conductor:
      exact_ = Exact::conductor;
      eta_ = s.eta;
      k_ = s.k;
      break;
    case Base::plastic:
      exact_ = Exact::opaque;
      break;
    case Base::thin_dielectric:
      alpha = 0;
      [[fallthrough]];
    case Base::dielectric:
      thin = s.base == Base::thin_dielectric;
      exact_ = thin ? Exact::pane : Exact::solid;
      glass = 1;
      glass_color = s.transmittance;
      break;
  }
  r0 = split(1, ior).reflected;
}

Interface::Split Interface::exact_split(float cos, float eta) const {
  if (exact_ == Exact::constant) return {reflectance_, Rgb(0, 0, 0)};
  if (exact_ == Exact::conductor) {
    const auto channel = [&](float n, float k) { return fresnel_conductor(cos, n, k); };
    const Rgb f(channel(eta_.x, k_.x), channel(eta_.y, k_.y), channel(eta_.z, k_.z));
    return {reflectance_ * f, Rgb(0, 0, 0)};
  }
  float f = fresnel_dielectric(cos, eta).reflectance;
  // R + T^2 R (1 + R^2 + R^4 + ...), with T = 1 - R.
  if (exact_ == Exact::pane) f = 2 * f / (1 + f);
  return {f * reflectance_, (1 - f) * glass_color};
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
