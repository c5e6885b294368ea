#pragma once

#include "renderer/materials/exact_surface.h"
#include "renderer/materials/specular.h"

namespace lacuna {

class RoughnessTable;

/// The attenuation of a Lambertian base by a reflecting GGX layer, or by an exact dielectric one.
///
/// With K(w) the mean of Fresnel's factor over the facets that reflect light to w, the base is
/// scaled by (1 - K(wo)) (1 - K(wi)) / (1 - mean K) (Kelemen and Szirmay-Kalos 2001, "A Microfacet
/// Based Coupled Specular-Matte BRDF Model", sec. 2.3). This is reciprocal, and a white base
/// reflects exactly the fraction 1 - K(wo) that the layer transmits. The sample implementation in
/// the appendix of glTF 2.0 uses 1 - F of the half vector instead, which nearly doubles the energy
/// at grazing angles.
///
/// Of the exact layer, 1 - K(w) is the fraction that its facets transmit by exact Fresnel, once
/// scattered. Since transmission is reciprocal, its mean is ior^2 (1 - F_int), with F_int the mean
/// reflectance from inside: the same formula is then that of a plastic's base (Walter et al. 2007
/// for the facets).
class Layer {
 public:
  Layer() = default;  ///< no layer
  /// Schlick's reflectances of the layer, each the largest channel, and its GGX width: 0 or at
  /// least ggx_min_alpha.
  Layer(float f0, float f90, float alpha);
  /// An exact dielectric layer; of two widths their geometric mean counts.
  Layer(float ior, const Roughness& roughness);

  /// Mean of schlick_weight() over the facets that reflect light to a direction with this cosine;
  /// of an exact layer 1 less what it transmits.
  float mean_weight(float cos) const;
  /// 1 - K of a direction: the fraction that reaches the base. In [0, 1].
  template <class T>
  T let_through(const T& mean_weight) const {
    return 1 - (f0_ + (f90_ - f0_) * mean_weight);
  }
  /// Factor of the base's f, from let_through() of the two directions.
  template <class T>
  T scale(float through_o, const T& through_i) const {
    return through_o * through_i * norm_;
  }
  /// The mean of let_through() over light from all around; 0: closed().
  float mean_let_through() const { return norm_ > 0 ? 1 / norm_ : 0; }
  /// Whether no light reaches the base.
  bool closed() const { return norm_ == 0; }

 private:
  friend class MeanWeights;

  float use(RoughnessTable& table, float alpha);

  float f0_ = 0, f90_ = 0;
  float norm_ = 1;                         // 1 / (1 - mean K)
  float row_ = -1;                         // position in the table; negative: the layer is smooth
  float ior_ = 0;                          // of an exact layer; 0: Schlick's formula
  const RoughnessTable* table_ = nullptr;  // of mean_weight(), if the layer is rough
};

}  // namespace lacuna
