#pragma once

#include "renderer/core/frame.h"
#include "renderer/materials/ggx.h"

namespace lacuna {

/// GGX facets around a unit normal: of one width, or of two along a tangent and across it (Heitz
/// 2014, app. B; KHR_materials_anisotropy). Directions are unit; those on the other side of the
/// normal count as their mirror images.
class Facets {
 public:
  Facets(const V3f& n, float alpha) : n_(n), alpha_(alpha) {}
  /// `tangent` is projected to the surface; where it is parallel to `n`, some tangent is used.
  Facets(const V3f& n, float alpha, float alpha_along, const V3f& tangent)
      : n_(n), alpha_(alpha), along_(alpha_along), two_widths_(true) {
    t_ = tangent - dot(tangent, n) * n;
    const float length2 = t_.length2();
    t_ = length2 > 1e-12F ? t_ * (1 / std::sqrt(length2)) : Frame(n).s;
    b_ = cross(n, t_);
  }

  /// Density of facet normals `m`, per projected area.
  float d(const V3f& m) const {
    if (!two_widths_) return ggx_d(m, n_, alpha_);
    const float x = dot(m, t_) / along_, y = dot(m, b_) / alpha_, z = dot(m, n_);
    const float s = x * x + y * y + z * z;
    return inv_pi / (along_ * alpha_ * s * s);
  }
  /// Masking G1(w) / cos; `cos` = |w.n| > 0.
  float g1_over_cos(const V3f& w, float cos) const {
    return ggx_g1_over_cos_of_root(cos, slope_root(w, cos));
  }
  /// Masking and shadowing G2 / (4 cos_o).
  float g2_over_4cos(const V3f& wo, float cos_o, const V3f& wi, float cos_i) const {
    return ggx_g2_over_4cos_of_roots(cos_o, slope_root(wo, cos_o), cos_i, slope_root(wi, cos_i));
  }
  /// Samples a facet normal visible from `wo`, on the side of n, with density G1 (wo.m) D / cos.
  V3f sample_visible(const V3f& wo, const V2f& u) const {
    if (!two_widths_) {
      const Frame frame(n_);
      return frame.to_world(ggx_sample_visible(frame.to_local(wo), alpha_, u));
    }
    const V3f m = ggx_sample_visible({dot(wo, t_), dot(wo, b_), dot(wo, n_)}, {along_, alpha_}, u);
    return m.x * t_ + m.y * b_ + m.z * n_;
  }

 private:
  float slope_root(const V3f& w, float cos) const {
    if (!two_widths_) return ggx_slope_root(cos, alpha_);
    const float x = dot(w, t_) * along_, y = dot(w, b_) * alpha_;
    return std::sqrt(x * x + y * y + cos * cos);
  }

  V3f n_;
  float alpha_, along_ = 0;
  bool two_widths_ = false;
  V3f t_, b_;  // set if there are two widths
};

}  // namespace lacuna
