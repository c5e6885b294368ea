#pragma once

#include <cstdint>

#include "renderer/core/vec.h"
#include "renderer/materials/interface.h"
#include "renderer/materials/layer.h"

namespace lacuna {

/// The parameters of the glTF surface model at one point, after texture lookups.
struct SurfaceParams {
  Rgb base_color{1, 1, 1};
  float metallic = 0;           ///< [0, 1]
  float alpha = 1;              ///< GGX width, roughness^2; below ggx_min_alpha: smooth, a delta
  float ior = 1.5F;             ///< >= 1; of the inside
  Rgb f0{0.04F, 0.04F, 0.04F};  ///< dielectric reflectance at normal incidence
  float f90 = 1;
  float transmission = 0;  ///< [0, 1]: refracting fraction of the dielectric's base
};

/// The scattering of a surface without its normals. Computed once for all hits if the material has
/// no textures.
struct Lobes {
  enum class Kind : std::uint8_t { black, lambert, layered };

  // Implicit: both types describe the same surface.
  Lobes(const SurfaceParams& params)
      : diffuse(((1 - params.metallic) * (1 - params.transmission)) * params.base_color) {
    if (params.metallic > 0 || params.transmission > 0 || params.f90 > 0 || !is_black(params.f0)) {
      add_interface(params);
    } else {
      kind = is_black(diffuse) ? Kind::black : Kind::lambert;
    }
  }

  bool has_diffuse() const { return !is_black(diffuse); }
  /// Whether other lobes than the facets must be sampled, too.
  bool facets_compete() const {
    return has_diffuse() || (interface.glass > 0 && interface.clear());
  }
  bool facets_transmit() const { return interface.glass > 0 && !interface.clear(); }

  Rgb diffuse;  ///< share of Lambert times base colour
  Kind kind = Kind::layered;
  Layer layer;  ///< used if facets_compete()
  Interface interface;

 private:
  void add_interface(const SurfaceParams& params);
};

}  // namespace lacuna
