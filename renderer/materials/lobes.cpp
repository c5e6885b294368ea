#include "renderer/materials/lobes.h"

namespace lacuna {

void Lobes::add_interface(const SurfaceParams& params) {
  interface = Interface(params);
  add_extensions(params);
  if (!facets_compete()) return;
  float f0 = max_component(params.f0);
  if (const ThinFilm& film = params.film; film.strength > 0) {
    // Schlick's formula is above what the film reflects, so that base and film gain no energy.
    f0 += film.strength * (params.f90 * film.schlick_bound(params.f0) - f0);
  }
  layer = Layer(f0, params.f90, interface.alpha);
  if (layer.closed()) diffuse = diffuse_through = Rgb(0, 0, 0);
}

void Lobes::add_extensions(const SurfaceParams& params) {
  medium = params.solid ? params.medium : nullptr;
  if (params.diffuse_transmission > 0) {
    const float share = (1 - params.metallic) * (1 - params.transmission);
    diffuse_through = (share * params.diffuse_transmission) * params.diffuse_transmission_color;
    diffuse *= 1 - params.diffuse_transmission;
  }
  if (params.coat > 0) covers.coat = Coat(params.coat, params.coat_alpha);
  if (!is_black(params.sheen_color)) {
    covers.sheen = Sheen(params.sheen_color, params.sheen_alpha);
  }
  if (params.alpha_along > 0 && !interface.smooth()) {
    alpha_along = params.alpha_along;
    direction = params.direction;
  }
  extended =
      !is_black(diffuse_through) || covers.any() || alpha_along > 0 || interface.film.strength > 0;
}

}  // namespace lacuna
