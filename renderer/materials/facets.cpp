#include "renderer/materials/facets.h"

#include "renderer/materials/beckmann.h"
#include "renderer/materials/specular.h"

namespace lacuna {

float Facets::general_d(const V3f& m, const V3f& wo) const {
  if (shape_ == FacetShape::phong) {
    const float cos = dot(reflect(wo, n_), reflect(wo, m));
    return cos > 0 ? 0.5F * inv_pi * std::pow(cos, phong_exponent()) : 0.0F;
  }
  if (!ggx()) return beckmann_d({dot(m, t_), dot(m, b_), dot(m, n_)}, {along_, alpha_});
  const float x = dot(m, t_) / along_, y = dot(m, b_) / alpha_, z = dot(m, n_);
  const float s = x * x + y * y + z * z;
  return inv_pi / (along_ * alpha_ * s * s);
}

float Facets::general_g1_over_cos(const V3f& w, float cos) const {
  if (ggx()) return ggx_g1_over_cos_of_root(cos, slope_root(w, cos));
  return beckmann_g1_over_cos({dot(w, t_), dot(w, b_), cos}, {along_, alpha_});
}

float Facets::general_g2_over_4cos(const V3f& wo, float cos_o, const V3f& wi, float cos_i) const {
  const V3f h = wo + wi;
  const float h2 = h.length2(), cos_h = dot(h, n_);
  switch (shape_) {
    case FacetShape::ggx:
      return ggx_g2_over_4cos_of_roots(cos_o, slope_root(wo, cos_o), cos_i, slope_root(wi, cos_i));
    case FacetShape::ggx_separable:
    case FacetShape::beckmann:
      return 0.25F * g1_over_cos(wo, cos_o) * (g1_over_cos(wi, cos_i) * cos_i);
    case FacetShape::ward_balanced:
      return cos_i / h2;
    case FacetShape::ward_duer:
    case FacetShape::ward: {
      const float cos2 = cos_h * cos_h / h2;
      const float o = std::max(cos_o, 0x1p-24F);  // finite: smaller cosines are rounding errors
      const float rest = shape_ == FacetShape::ward ? std::sqrt(cos_i / o) : 1 / o;
      return 0.25F * cos2 * cos2 * rest;
    }
    case FacetShape::phong:
      return (phong_exponent() + 2) * cos_i;
  }
  return 0;
}

V3f Facets::general_sample(const V3f& wo, const V2f& u) const {
  if (shape_ == FacetShape::phong) return sample_phong(wo, u);
  const V2f widths(along_, alpha_);
  const V3f local(dot(wo, t_), dot(wo, b_), dot(wo, n_));
  V3f m;
  if (ggx()) {
    m = ggx_sample_visible(local, widths, u);
  } else if (shape_ == FacetShape::beckmann) {
    m = beckmann_sample_visible(local, widths, u);
  } else {
    // Seen from above all normals are visible, with density D cos: as Ward samples them.
    m = beckmann_sample_visible({0, 0, 1}, widths, u);
  }
  return m.x * t_ + m.y * b_ + m.z * n_;
}

V3f Facets::sample_phong(const V3f& wo, const V2f& u) const {
  // cos^(n + 1) is uniform; its sine without the loss of 1 - cos^2 for large n.
  const double log_cos = std::log1p(-double(u.x)) / (double(phong_exponent()) + 1);
  const auto cos = static_cast<float>(std::exp(log_cos));
  const auto sin = static_cast<float>(std::sqrt(-std::expm1(2 * log_cos)));
  const float phi = 2 * pi * u.y;
  const V3f wi = Frame(reflect(wo, n_)).to_world({sin * std::cos(phi), sin * std::sin(phi), cos});
  const V3f h = wo + wi;
  const float length2 = h.length2();
  return length2 > 0 ? h * (1 / std::sqrt(length2)) : n_;
}

float Facets::general_sampled_over_d(const V3f& wo, float cos_o, const V3f& m) const {
  switch (shape_) {
    case FacetShape::ward:
    case FacetShape::ward_duer:
    case FacetShape::ward_balanced:
      return dot(m, n_) / dot(wo, m);
    case FacetShape::phong:
      return 4 * (phong_exponent() + 1);
    default:
      return g1_over_cos(wo, cos_o);
  }
}

}  // namespace lacuna
