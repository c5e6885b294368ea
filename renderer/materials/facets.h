#pragma once

#include "renderer/core/frame.h"
#include "renderer/geometry/facet_shape.h"
#include "renderer/materials/ggx.h"

namespace lacuna {

/// Facets around a unit normal: of glTF's GGX and one width, or of any shape and of two widths
/// along a tangent and across it (Heitz 2014, app. B; KHR_materials_anisotropy). Directions are
/// unit; those on the other side of the normal count as their mirror images.
class Facets {
 public:
  Facets(const V3f& n, float alpha) : n_(n), alpha_(alpha) {}
  /// `tangent` is projected to the surface; where it is parallel to `n`, some tangent is used.
  Facets(const V3f& n, float alpha, float alpha_along, const V3f& tangent, FacetShape shape)
      : n_(n), alpha_(alpha), along_(alpha_along), shape_(shape), general_(true) {
    t_ = tangent - dot(tangent, n) * n;
    const float length2 = t_.length2();
    t_ = length2 > 1e-12F ? t_ * (1 / std::sqrt(length2)) : Frame(n).s;
    b_ = cross(n, t_);
  }

  /// Density of facet normals `m`, per projected area. Of Phong's lobe: cos^n / (2 pi) for the
  /// direction that `m` reflects `wo` to.
  float d(const V3f& m, const V3f& wo) const {
    return general_ ? general_d(m, wo) : ggx_d(m, n_, alpha_);
  }
  /// Smith's masking G1(w) / cos; `cos` = |w.n| > 0. Not for Ward's and Phong's lobes.
  float g1_over_cos(const V3f& w, float cos) const {
    if (general_) return general_g1_over_cos(w, cos);
    return ggx_g1_over_cos_of_root(cos, ggx_slope_root(cos, alpha_));
  }
  /// f cos_i over the reflectance and d(): with Smith's functions G2 / (4 cos_o).
  float g2_over_4cos(const V3f& wo, float cos_o, const V3f& wi, float cos_i) const {
    if (general_) return general_g2_over_4cos(wo, cos_o, wi, cos_i);
    return ggx_g2_over_4cos_of_roots(cos_o, ggx_slope_root(cos_o, alpha_), cos_i,
                                     ggx_slope_root(cos_i, alpha_));
  }
  /// `x` times G2 / G1(wo), Smith's shadowing of what is visible from `wo`, for `wi` on either
  /// side.
  float shadowed(float x, const V3f& wo, float cos_o, const V3f& wi, float cos_i) const {
    if (shape_ != FacetShape::ggx) return x * g1_over_cos(wi, cos_i) * cos_i;
    return x * 4 * g2_over_4cos(wo, cos_o, wi, cos_i) / g1_over_cos(wo, cos_o);
  }
  /// Samples a facet normal, on the side of n, with density sampled_over_d() (wo.m) d(). Those that
  /// are visible from `wo`, if the shape has Smith's masking.
  V3f sample(const V3f& wo, const V2f& u) const {
    if (general_) return general_sample(wo, u);
    const Frame frame(n_);
    return frame.to_world(ggx_sample_visible(frame.to_local(wo), alpha_, u));
  }
  /// For visible normals g1_over_cos(wo, cos_o). A quarter of it times d() is the density of the
  /// reflected direction, as dm / dwi = 1 / (4 wo.m).
  float sampled_over_d(const V3f& wo, float cos_o, const V3f& m) const {
    return general_ ? general_sampled_over_d(wo, cos_o, m) : g1_over_cos(wo, cos_o);
  }

 private:
  bool ggx() const { return shape_ == FacetShape::ggx || shape_ == FacetShape::ggx_separable; }
  float slope_root(const V3f& w, float cos) const {
    const float x = dot(w, t_) * along_, y = dot(w, b_) * alpha_;
    return std::sqrt(x * x + y * y + cos * cos);
  }
  float phong_exponent() const { return 2 / (alpha_ * alpha_) - 2; }
  // Not inline: few surfaces have them.
  float general_d(const V3f& m, const V3f& wo) const;
  float general_g1_over_cos(const V3f& w, float cos) const;
  float general_g2_over_4cos(const V3f& wo, float cos_o, const V3f& wi, float cos_i) const;
  V3f general_sample(const V3f& wo, const V2f& u) const;
  float general_sampled_over_d(const V3f& wo, float cos_o, const V3f& m) const;
  V3f sample_phong(const V3f& wo, const V2f& u) const;

  V3f n_;
  float alpha_, along_ = 0;
  FacetShape shape_ = FacetShape::ggx;
  bool general_ = false;
  V3f t_, b_;  // set if general_
};

}  // namespace lacuna
