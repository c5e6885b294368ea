#include "renderer/materials/lobes.h"

namespace lacuna {

void Lobes::add_interface(const SurfaceParams& params) {
  interface = Interface(params);
  if (!facets_compete()) return;
  layer = Layer(max_component(params.f0), params.f90, interface.alpha);
  if (layer.closed()) diffuse = Rgb(0, 0, 0);
}

}  // namespace lacuna
