#pragma once

#include "renderer/core/vec.h"

namespace lacuna {

/// A thin film over a surface, in air: its interference colours the reflection
/// (KHR_materials_iridescence; Belcour and Barla 2017, "A Practical Extension to Microfacet Theory
/// for the Modeling of Varying Iridescence").
struct ThinFilm {
  float strength = 0;   ///< [0, 1]; 0: no film
  float ior = 1.3F;     ///< >= 1
  float thickness = 0;  ///< nm, >= 0

  /// Reflectance, [0, 1] in each channel, of the film over a base of reflectance `f0` at normal
  /// incidence, for light at `cos` outside.
  Rgb reflectance(float cos, const Rgb& f0) const;
  /// The least reflectance at normal incidence with which Schlick's formula up to 1 is at no angle
  /// below the largest channel of reflectance().
  float schlick_bound(const Rgb& f0) const;
};

}  // namespace lacuna
