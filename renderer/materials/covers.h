#pragma once

#include "renderer/materials/ggx.h"
#include "renderer/materials/layer.h"
#include "renderer/materials/sheen.h"

namespace lacuna {

/// Index of refraction 1.5 (KHR_materials_clearcoat).
inline constexpr float coat_f0 = 0.04F;

/// A colourless coat: GGX with Schlick's reflectance, on a share of the surface.
struct Coat {
  Coat() = default;  ///< none
  /// `share` in [0, 1]; `alpha` in [0, 1]: below ggx_min_alpha the coat is smooth.
  Coat(float share, float alpha_of_coat)
      : strength(share),
        alpha(alpha_of_coat < ggx_min_alpha ? 0 : alpha_of_coat),
        layer(strength * coat_f0, strength, alpha) {}

  bool any() const { return strength > 0; }
  bool smooth() const { return alpha == 0; }
  /// Reflectance of a facet for light at `cos`.
  float reflectance(float cos) const {
    return strength * (coat_f0 + (1 - coat_f0) * schlick_weight(cos));
  }
  float let_through(float cos) const {
    return any() ? layer.let_through(layer.mean_weight(cos)) : 1.0F;
  }

  float strength = 0;
  float alpha = 0;
  Layer layer;
};

/// What lies on a surface: sheen, and a coat over it. With T(w) the fraction of the light of a
/// direction that a cover lets through, what is below is scaled by min(T(wo), T(wi)). That is
/// reciprocal, and creates no energy over any base, since the integral of f min(T(wo), T(wi)) is at
/// most T(wo) times the albedo of f. It is exact over a mirror. (KHR_materials_sheen has this; the
/// coat of KHR_materials_clearcoat is scaled by T(wo) alone, which is not reciprocal; T(wo) T(wi)
/// over its mean, as in layer.h, would create energy over glossy bases.)
struct Covers {
  Coat coat;
  Sheen sheen;

  bool any() const { return coat.any() || sheen.any(); }

  /// T of both covers for one direction.
  struct Through {
    float coat = 1, sheen = 1;
    float both() const { return coat * sheen; }
  };
  Through through(float cos, float coat_cos) const {
    return {coat.let_through(coat_cos), sheen.let_through(cos)};
  }
};

}  // namespace lacuna
