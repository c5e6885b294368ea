#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "renderer/core/vec.h"
#include "renderer/geometry/facet_shape.h"
#include "renderer/materials/ggx.h"

namespace lacuna {

/// Microfacets of LACUNA_materials.
struct Roughness {
  V2f alpha{0, 0};  ///< widths along u and across; below ggx_min_alpha: smooth
  FacetShape shape = FacetShape::ggx_separable;

  /// `alpha`, at least ggx_min_alpha; (0, 0): smooth.
  V2f widths() const {
    if (!(std::max(alpha.x, alpha.y) >= ggx_min_alpha)) return {0, 0};
    return {std::max(alpha.x, ggx_min_alpha), std::max(alpha.y, ggx_min_alpha)};
  }
};

/// A dielectric layer over a surface: refracts what passes, and absorbs.
struct CoatingParams {
  float ior = 1.5F;  ///< above 0
  Roughness roughness = {};
  Rgb reflectance{1, 1, 1};    ///< scale of the reflection
  Rgb optical_depth{0, 0, 0};  ///< along the normal, >= 0
};

/// A surface of LACUNA_materials at one point, after texture lookups (LacunaMaterial). Its diffuse
/// reflectance is SurfaceParams::base_color.
struct ExactSurface {
  enum class Base : std::uint8_t {
    gltf,  ///< the lobes of SurfaceParams: below a coating, a part of a mixture, or one-sided
    diffuse,
    conductor,
    dielectric,
    thin_dielectric,
    plastic,
    glossy,  ///< facets of constant reflectance over Lambert
  };
  Base base = Base::gltf;
  bool one_sided = false;
  bool nonlinear = false;
  float sigma = 0;
  Roughness roughness = {};
  float ior = 1.5F;
  Rgb eta{1, 1, 1}, k{0, 0, 0};
  Rgb reflectance{1, 1, 1}, transmittance{1, 1, 1};
  Rgb scale{1, 1, 1};  ///< of all lobes
  std::optional<CoatingParams> coating = {};
};

}  // namespace lacuna
