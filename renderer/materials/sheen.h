#pragma once

#include "renderer/core/vec.h"

namespace lacuna {

// The fibres of cloth (KHR_materials_sheen): the "Charlie" distribution of facet normals and its
// shadowing (Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF"). Cosines are
// positive, with the normal.

/// Narrower distributions are read as this one: fibres this straight are seen at the horizon only.
inline constexpr float sheen_min_alpha = 0.01F;

/// Charlie's facets scatter more than they get at grazing angles, at widths below .5: up to four
/// times as much. Here each direction is bounded: the lobe is D V min(1, 1 / E(wo), 1 / E(wi)),
/// with E the albedo of D V.
class Sheen {
 public:
  Sheen() = default;  ///< none
  /// `color` in [0, 1]; `alpha` = roughness^2 in [0, 1].
  Sheen(const Rgb& color, float alpha);

  bool any() const { return row_ >= 0; }
  /// min(1, E) of a direction: the albedo of a white sheen, nearly.
  float albedo(float cos) const;
  /// The fraction that reaches the base: 1 less the largest channel of the albedo.
  float let_through(float cos) const { return any() ? 1 - max_component(color_) * albedo(cos) : 1; }
  /// f cos_i of the lobe; `sin2` the squared sine between the half vector and the normal.
  Rgb eval(float cos_o, float cos_i, float sin2) const;
  const Rgb& color() const { return color_; }

 private:
  Rgb color_{0, 0, 0};
  float alpha_ = 0;
  float row_ = -1;  // in the table of albedos; negative: none
};

}  // namespace lacuna
