#pragma once

#include <optional>

#include "renderer/materials/exact_surface.h"
#include "renderer/materials/facets.h"
#include "renderer/materials/layer.h"
#include "renderer/materials/specular.h"

namespace lacuna {

/// A dielectric layer over an opaque surface (LACUNA_materials). A direction w is refracted to w'
/// in the layer. With T(w) the fraction that passes its boundary and f_b the base,
///
///   f(wo, wi) = T(wo) T(wi) exp(-depth (1 / cos_o' + 1 / cos_i')) f_b(wo', wi') / ior^2
///
/// plus the reflection at the boundary. What the base sends back from inside is not reflected
/// again.
class Coating {
 public:
  explicit Coating(const CoatingParams& p)
      : widths_(p.roughness.widths()),
        shape_(p.roughness.shape),
        ior_(p.ior),
        reflectance_(p.reflectance),
        optical_depth_(p.optical_depth),
        layer_(p.ior, p.roughness) {}

  bool smooth() const { return widths_.y == 0; }
  float alpha() const { return widths_.y; }
  bool two_widths() const { return widths_.x != widths_.y; }
  /// The boundary's facets; rough.
  Facets facets(const V3f& n, const V3f& along) const {
    return {n, widths_.y, widths_.x, along, shape_};
  }
  /// Reflectance of a facet for light at `cos`.
  Rgb reflectance(float cos) const {
    return fresnel_dielectric(cos, ior_).reflectance * reflectance_;
  }

  const Rgb& reflectance() const { return reflectance_; }  ///< CoatingParams::reflectance

  /// A direction and its refracted one, which leaves the base.
  struct Refracted {
    V3f w;                 ///< unit; undefined if `through` is black
    float cos = 0;         ///< with the normal
    Rgb through{0, 0, 0};  ///< T times the absorption on the way
  };
  /// `w` outside, unit, with dot(w, n) = `cos` > 0.
  Refracted enter(const V3f& w, const V3f& n, float cos) const {
    const Fresnel f = fresnel_dielectric(cos, ior_);
    if (f.total) return {};
    return {-refract(w, n, ior_, f.cos_t), f.cos_t, let_through(cos) * absorption(f.cos_t)};
  }
  /// The direction outside for `w` that leaves the base; none under total reflection.
  std::optional<V3f> leave(const V3f& w, const V3f& n) const {
    const Fresnel f = fresnel_dielectric(dot(w, n), 1 / ior_);
    if (f.total) return std::nullopt;
    return -refract(w, n, 1 / ior_, f.cos_t);
  }
  /// dw' / dw with the cosines outside and inside.
  float jacobian(float cos, float cos_in) const { return cos / (ior_ * ior_ * cos_in); }
  /// Of the way inside for light at `cos` outside; black under total reflection.
  Rgb absorption_at(float cos) const {
    const Fresnel f = fresnel_dielectric(cos, ior_);
    return f.total ? Rgb(0, 0, 0) : absorption(f.cos_t);
  }
  float let_through(float cos) const { return layer_.let_through(layer_.mean_weight(cos)); }

 private:
  Rgb absorption(float cos_in) const {
    const auto channel = [&](float depth) { return depth > 0 ? std::exp(-depth / cos_in) : 1.0F; };
    return {channel(optical_depth_.x), channel(optical_depth_.y), channel(optical_depth_.z)};
  }

  V2f widths_;
  FacetShape shape_;
  float ior_;
  Rgb reflectance_, optical_depth_;
  Layer layer_;
};

}  // namespace lacuna
