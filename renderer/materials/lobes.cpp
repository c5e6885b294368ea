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
  if (params.coat > 0) more.covers.coat = Coat(params.coat, params.coat_alpha);
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

}  // namespace lacuna
