#pragma once

#include "renderer/core/sampling.h"
#include "renderer/core/vec.h"

namespace lacuna {

// The GGX distribution of facet normals with Smith's shadowing (Walter et al. 2007; Heitz 2014,
// "Understanding the Masking-Shadowing Function"). Isotropic, width `alpha` in [ggx_min_alpha, 1];
// facets.h has two widths. Cosines are positive.

/// Lobes below this width are treated as smooth. A float direction has a rounding error of about
/// 6e-8, 6e-4 of a lobe of this width: its density is still accurate to a fraction of a percent.
/// Sharper lobes would be rounding noise, and are narrower than a pixel of any picture.
inline constexpr float ggx_min_alpha = 1e-4F;

/// Density of facet normals, per projected area, from the cosine and squared sine of the angle to
/// the mean normal; T and A are float or Float8. The sine is an argument because 1 - cos^2 would
/// lose it for small alpha.
template <class T, class A>
T ggx_d(const T& cos, const T& sin2, const A& alpha) {
  const A a2 = alpha * alpha;
  const T t = sin2 / a2 + cos * cos;
  return 1 / (std::numbers::pi_v<float> * a2 * t * t);
}
/// ggx_d() of the facet normal `m` around `n`.
inline float ggx_d(const V3f& m, const V3f& n, float alpha) {
  return ggx_d(dot(m, n), cross(n, m).length2(), alpha);
}

/// sqrt(alpha^2 + (1 - alpha^2) cos^2), a term of all of Smith's functions.
template <class T, class A>
T ggx_slope_root(const T& cos, const A& alpha) {
  using std::sqrt;
  const A a2 = alpha * alpha;
  return sqrt(a2 + (1 - a2) * cos * cos);
}

/// Masking G1(w) / cos: finite at grazing angles. `root` of w.
inline float ggx_g1_over_cos_of_root(float cos, float root) { return 2 / (cos + root); }
inline float ggx_g1_over_cos(float cos, float alpha) {
  return ggx_g1_over_cos_of_root(cos, ggx_slope_root(cos, alpha));
}

/// Height-correlated masking and shadowing (Heitz 2014, eq. 99) over four times the first cosine:
/// G2 / (4 cos_o).
template <class O, class T, class A>
T ggx_g2_over_4cos(const O& cos_o, const T& cos_i, const A& alpha) {
  return 0.5F / (ggx_slope_root(cos_o, alpha) + cos_o * ggx_slope_root(cos_i, alpha) / cos_i);
}
/// The same from the slope roots of both directions.
inline float ggx_g2_over_4cos_of_roots(float cos_o, float root_o, float cos_i, float root_i) {
  return 0.5F / (root_o + cos_o * root_i / cos_i);
}

/// Samples a facet normal visible from `wo` in the local frame (normal along z, wo.z > 0), with
/// density G1(wo) (wo.m) D(m) / wo.z (Heitz 2018, "Sampling the GGX Distribution of Visible
/// Normals"). `alpha`: the widths along x and y.
V3f ggx_sample_visible(const V3f& wo, const V2f& alpha, const V2f& u);
inline V3f ggx_sample_visible(const V3f& wo, float alpha, const V2f& u) {
  return ggx_sample_visible(wo, V2f(alpha, alpha), u);
}

}  // namespace lacuna
