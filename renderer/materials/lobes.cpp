#include "renderer/materials/lobes.h"

namespace lacuna {

void Lobes::add_interface(const SurfaceParams& params) {
  interface = Interface(params);
  medium = params.solid ? params.medium : nullptr;
  add_further(params);
  if (!facets_compete()) return;
  float f0 = max_component(params.f0);
  if (const ThinFilm& film = params.film; film.strength > 0) {
    // Schlick's formula is above what the film reflects, so that base and film gain no energy.
    f0 += film.strength * (params.f90 * film.schlick_bound(params.f0) - f0);
  }
  layer = Layer(f0, params.f90, interface.alpha);
  if (!layer.closed()) return;
  diffuse = Rgb(0, 0, 0);
  if (further) further->diffuse_through = Rgb(0, 0, 0);
}

void Lobes::add_further(const SurfaceParams& params) {
  const bool two_widths = params.alpha_along > 0 && !interface.smooth();
  if (!has_further(params) && !two_widths && !(interface.film.strength > 0)) return;
  FurtherLobes more;
  if (params.diffuse_transmission > 0) {
    const float share = (1 - params.metallic) * (1 - params.transmission);
    more.diffuse_through =
        (share * params.diffuse_transmission) * params.diffuse_transmission_color;
    diffuse *= 1 - params.diffuse_transmission;
  }
  if (params.coat > 0) {
    // A mirror about a normal of its own would be a second delta lobe: it is the sharpest rough
    // one.
    const float least = params.coat_normal ? ggx_min_alpha : 0.0F;
    more.covers.coat = Coat(params.coat, std::max(params.coat_alpha, least));
    more.coat_normal = params.coat_normal;
  }
  if (!is_black(params.sheen_color)) {
    more.covers.sheen = Sheen(params.sheen_color, params.sheen_alpha);
  }
  if (two_widths) {
    more.alpha_along = params.alpha_along;
    more.direction = params.direction;
  }
  if (!is_black(more.diffuse_through) || more.covers.any() || two_widths ||
      interface.film.strength > 0) {
    further = more;
  }
}

void Lobes::make_exact(const SurfaceParams& params) {
  const ExactSurface& e = *params.exact;
  make_base(params);
  if (e.one_sided || e.coating || kind == Kind::layered) {
    kind = Kind::layered;
    if (!further) further.emplace();
    further->one_sided = e.one_sided;
    further->scale = e.scale;
    if (e.coating) further->coating.emplace(*e.coating);
  } else {
    diffuse *= e.scale;
  }
}

/// The lobes of ExactSurface::base.
void Lobes::make_base(const SurfaceParams& params) {
  using Base = ExactSurface::Base;
  const ExactSurface& e = *params.exact;
  if (e.base == Base::gltf) {
    SurfaceParams plain = params;
    plain.exact.reset();
    *this = Lobes(plain);
    return;
  }
  diffuse = params.base_color;
  if (e.base == Base::diffuse && e.sigma == 0) {
    kind = is_black(diffuse) ? Kind::black : Kind::lambert;
    return;
  }
  interface = Interface(e);
  further.emplace();
  further->sigma = e.sigma;
  if (!interface.smooth()) {
    further->alpha_along = e.roughness.widths().x;
    further->shape = e.roughness.shape;
  }
  switch (e.base) {
    case Base::plastic: {
      layer = Layer(e.ior, e.roughness);
      // The mean reflectance from inside, by reciprocity.
      const float let_out = layer.mean_let_through() / (e.ior * e.ior);
      const auto tinted = [&](float kd) { return kd * let_out / (1 - kd * (1 - let_out)); };
      if (e.nonlinear) diffuse = {tinted(diffuse.x), tinted(diffuse.y), tinted(diffuse.z)};
      break;
    }
    case Base::conductor:
    case Base::dielectric:
    case Base::thin_dielectric:
      diffuse = Rgb(0, 0, 0);
      medium = e.base == Base::dielectric ? params.medium : nullptr;
      break;
    default:
      break;
  }
}

}  // namespace lacuna
