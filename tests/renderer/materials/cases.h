#pragma once

#include <array>
#include <string>
#include <vector>

#include "renderer/core/rng.h"
#include "renderer/materials/bsdf.h"

namespace lacuna::cases {

// The surfaces and views that every property is tested on.

struct Surface {
  std::string name;
  SurfaceParams params;

  /// Whether the formulas bound what is reflected: Ward's do not, at grazing angles.
  bool bounded() const {
    const FacetShape shape = params.exact ? params.exact->roughness.shape : FacetShape::ggx;
    return shape != FacetShape::ward && shape != FacetShape::ward_duer;
  }
  bool opaque() const {
    if (params.exact) {
      return params.exact->base != ExactSurface::Base::dielectric &&
             params.exact->base != ExactSurface::Base::thin_dielectric;
    }
    return (params.transmission == 0 && params.diffuse_transmission == 0) || params.metallic == 1;
  }
  /// Whether radiance and importance are scattered alike where ns = ng.
  bool reciprocal() const { return !params.coat_normal; }
};

/// Index of refraction behind the surface, as far as light that passes is refracted.
inline float index_behind(const SurfaceParams& p) {
  if (p.exact) return p.exact->base == ExactSurface::Base::dielectric ? p.exact->ior : 1.0F;
  return p.solid && p.transmission * (1 - p.metallic) > 0 ? p.ior : 1.0F;
}

/// With a tangent frame, for surfaces whose facets have two widths.
inline Bsdf bsdf(const SurfaceParams& params, const V3f& ng, const V3f& ns) {
  Bsdf result(params, ng, ns);
  const Frame frame(ng);
  result.set_tangents(frame.s, frame.t);
  return result;
}

/// Reflectances as KHR_materials_ior gives them; what is transmitted is refracted.
inline SurfaceParams dielectric(const Rgb& base, float alpha, float ior, float transmission) {
  SurfaceParams p;
  p.base_color = base;
  p.alpha = alpha;
  p.ior = ior;
  const float f0 = normal_reflectance(ior);
  p.f0 = Rgb(f0, f0, f0);
  p.transmission = transmission;
  p.solid = true;
  return p;
}
inline SurfaceParams thin(SurfaceParams p) {
  p.solid = false;
  return p;
}
inline SurfaceParams leaf(SurfaceParams p, float share) {
  p.diffuse_transmission = share;
  p.diffuse_transmission_color = Rgb(0.9F, 0.6F, 0.3F);
  return p;
}
inline SurfaceParams coated(SurfaceParams p, float coat, float alpha) {
  p.coat = coat;
  p.coat_alpha = alpha;
  return p;
}
inline SurfaceParams cloth(SurfaceParams p, const Rgb& color, float alpha) {
  p.sheen_color = color;
  p.sheen_alpha = alpha;
  return p;
}
inline SurfaceParams brushed(SurfaceParams p, float alpha_along) {
  p.alpha_along = alpha_along;
  p.direction = V2f(0.6F, 0.8F);
  return p;
}
inline SurfaceParams filmed(SurfaceParams p, float strength, float thickness) {
  p.film = {strength, 1.3F, thickness};
  return p;
}
inline SurfaceParams lambert(const Rgb& base) {
  SurfaceParams p;
  p.base_color = base;
  p.f0 = Rgb(0, 0, 0);
  p.f90 = 0;
  return p;
}
inline SurfaceParams metal(const Rgb& base, float alpha) {
  SurfaceParams p;
  p.base_color = base;
  p.alpha = alpha;
  p.metallic = 1;
  return p;
}
inline SurfaceParams mixed(SurfaceParams p, float metallic) {
  p.metallic = metallic;
  return p;
}
inline SurfaceParams layer(SurfaceParams p, const Rgb& f0, float f90) {
  p.f0 = f0;
  p.f90 = f90;
  return p;
}

/// A surface of LACUNA_materials. Also sets those of SurfaceParams' own values that describe it to
/// tests: the width of its narrowest facets and whether it transmits.
inline SurfaceParams exact(const ExactSurface& e, const Rgb& base = Rgb(1, 1, 1)) {
  SurfaceParams p;
  p.exact = e;
  p.base_color = base;
  p.alpha = std::min(e.roughness.alpha.x, e.roughness.alpha.y);
  p.ior = e.ior;
  p.solid = e.base == ExactSurface::Base::dielectric;
  p.transmission = p.solid || e.base == ExactSurface::Base::thin_dielectric ? 1 : 0;
  p.f90 = e.base == ExactSurface::Base::diffuse ? 0 : 1;
  return p;
}
inline SurfaceParams metal_of(const Roughness& r) {
  return exact({.base = ExactSurface::Base::conductor,
                .roughness = r,
                .eta = {1.657F, 0.880F, 0.521F},
                .k = {9.224F, 6.270F, 4.837F}});
}
inline SurfaceParams glass_of(float ior, const Roughness& r) {
  return exact({.base = ExactSurface::Base::dielectric, .roughness = r, .ior = ior});
}
inline SurfaceParams plastic_of(const Roughness& r, bool nonlinear) {
  return exact({.base = ExactSurface::Base::plastic, .nonlinear = nonlinear, .roughness = r},
               {0.6F, 0.3F, 0.1F});
}
/// A glossy lobe of reflectance .4 over a diffuse one.
inline SurfaceParams glossy_of(const Roughness& r) {
  return exact({.base = ExactSurface::Base::glossy, .roughness = r, .reflectance = Rgb(0.4F)},
               Rgb(0.4F));
}
inline SurfaceParams phong_of(float exponent) {
  const float alpha = std::sqrt(2 / (exponent + 2));
  return glossy_of({{alpha, alpha}, FacetShape::phong});
}
/// Under a dielectric coating of index 1.5.
inline SurfaceParams coated_with(SurfaceParams p, const Roughness& r, const Rgb& depth) {
  if (!p.exact) p.exact.emplace();
  p.exact->coating = CoatingParams{.roughness = r, .optical_depth = depth};
  return p;
}
inline SurfaceParams one_sided(SurfaceParams p) {
  if (!p.exact) p.exact.emplace();
  p.exact->one_sided = true;
  return p;
}
inline Roughness facets(float alpha, FacetShape shape = FacetShape::ggx_separable) {
  return {{alpha, alpha}, shape};
}

/// The geometric normal of all views. No axis, so that mixed-up frames show.
inline V3f view_normal() { return V3f(1, -2, 0.5F).normalized(); }
/// A direction in the frame of ng.
inline V3f direction(const V3f& ng, float cos, float phi) {
  const float sin = std::sqrt(1 - cos * cos);
  return Frame(ng).to_world({sin * std::cos(phi), sin * std::sin(phi), cos}).normalized();
}
/// With a coat whose normal leans by this cosine.
inline SurfaceParams bent_coat(SurfaceParams p, float cos, float alpha) {
  p = coated(p, 1, alpha);
  p.coat_normal = direction(view_normal(), cos, 2.5F);
  return p;
}

/// Of LACUNA_materials.
inline std::vector<Surface> exact_surfaces() {
  using Base = ExactSurface::Base;
  const Roughness smooth{}, beckmann = facets(0.2F, FacetShape::beckmann);
  const Rgb white(1, 1, 1), none(0, 0, 0), depth(0.1F, 0.3F, 0.6F);
  const SurfaceParams rough_diffuse = exact({.base = Base::diffuse, .sigma = 0.3F}, Rgb(0.9F));
  return {
      {"oren_nayar", rough_diffuse},
      {"one_sided_lambert", one_sided(lambert(white))},
      {"gold_smooth", metal_of(smooth)},
      {"aluminium_ggx", metal_of(facets(0.2F))},
      {"aluminium_beckmann", metal_of(beckmann)},
      {"aluminium_beckmann_sharp", metal_of(facets(0.005F, FacetShape::beckmann))},
      {"aluminium_correlated", metal_of(facets(0.4F, FacetShape::ggx))},
      {"aluminium_brushed_correlated", metal_of({{0.2F, 0.6F}, FacetShape::ggx})},
      {"solid_correlated", glass_of(1.5F, facets(0.2F, FacetShape::ggx))},
      {"lacquer_correlated", plastic_of(facets(0.4F, FacetShape::ggx), true)},
      {"varnish_correlated",
       coated_with(metal_of(facets(0.3F)), facets(0.3F, FacetShape::ggx), none)},
      {"aluminium_brushed", metal_of({{0.1F, 0.4F}, FacetShape::ggx_separable})},
      {"aluminium_brushed_beckmann", metal_of({{0.5F, 0.1F}, FacetShape::beckmann})},
      {"aluminium_one_sided", one_sided(metal_of(facets(0.3F)))},
      {"solid_smooth", glass_of(1.5F, smooth)},
      {"solid_bubble", glass_of(1 / 1.5F, facets(0.2F))},
      {"solid_ggx", glass_of(1.5F, facets(0.2F))},
      {"solid_beckmann", glass_of(1.5F, beckmann)},
      {"pane", exact({.base = Base::thin_dielectric,
                      .reflectance = {0.9F, 0.8F, 1},
                      .transmittance = {0.5F, 1, 0.7F}})},
      {"lacquer_smooth", plastic_of(smooth, false)},
      {"lacquer_nonlinear", plastic_of(smooth, true)},
      {"lacquer_ggx", plastic_of(facets(0.1F), true)},
      {"lacquer_beckmann", plastic_of(beckmann, false)},
      {"phong_30", phong_of(30)},
      {"phong_1", phong_of(1)},
      {"ward_balanced", glossy_of(facets(0.15F, FacetShape::ward_balanced))},
      {"ward_balanced_brushed", glossy_of({{0.1F, 0.3F}, FacetShape::ward_balanced})},
      {"ward_duer", glossy_of(facets(0.15F, FacetShape::ward_duer))},
      {"ward_1992", glossy_of(facets(0.15F, FacetShape::ward))},
      {"varnished_lambert", coated_with(lambert(white), smooth, depth)},
      {"varnished_mirror", coated_with(metal_of(smooth), smooth, none)},
      {"varnished_metal", coated_with(metal_of(facets(0.3F)), smooth, depth)},
      {"varnished_plastic", coated_with(dielectric(white, 0.2F, 1.5F, 0), smooth, none)},
      {"rough_varnish", coated_with(metal_of(facets(0.3F)), facets(0.1F), none)},
      {"rough_varnish_over_mirror", coated_with(metal_of(smooth), beckmann, depth)},
      {"rough_varnish_one_sided", one_sided(coated_with(lambert(white), facets(0.2F), none))},
  };
}

inline std::vector<Surface> surfaces() {
  const Rgb white(1, 1, 1), black(0, 0, 0), orange(0.8F, 0.5F, 0.2F);
  std::vector<Surface> all{
      {"window_smooth", thin(dielectric(orange, 0, 1.5F, 1))},
      {"window_alpha_02", thin(dielectric(white, 0.2F, 1.5F, 1))},
      {"half_window", thin(dielectric(orange, 1, 1, 0.5F))},
      {"leaf", leaf(lambert(white), 0.4F)},
      {"wax", leaf(dielectric(white, 0.2F, 1.5F, 0.5F), 0.5F)},
      {"coated_metal", coated(metal(white, 0.3F), 1, 0)},
      {"coated_mirror", coated(metal(orange, 0), 0.7F, 0)},
      {"coated_plastic", coated(leaf(dielectric(white, 0, 1.5F, 0), 1), 0.8F, 0.2F)},
      {"coated_glass", coated(dielectric(white, 0.2F, 1.5F, 1), 1, 0.4F)},
      {"bent_coat_over_metal", bent_coat(metal(white, 0.3F), 0.95F, 0.2F)},
      {"bent_coat_over_mirror", bent_coat(metal(orange, 0), 0.9F, 0.1F)},
      {"bent_coat_over_leaf", bent_coat(leaf(dielectric(white, 0, 1.5F, 0), 0.5F), 0.8F, 0.3F)},
      {"bent_coat_over_glass", bent_coat(dielectric(white, 0.2F, 1.5F, 1), 0.9F, 0.2F)},
      {"bent_coat_over_cloth", bent_coat(cloth(lambert(white), white, 0.3F), 0.5F, 0.2F)},
      {"bent_sharp_coat", bent_coat(lambert(orange), 0.95F, 0)},
      {"cloth", cloth(lambert(white), white, 0.3F)},
      {"coated_cloth", coated(cloth(dielectric(orange, 0.3F, 1.5F, 0), orange, 0.05F), 1, 0.1F)},
      {"brushed_metal", brushed(metal(white, 0.05F), 0.4F)},
      {"brushed_plastic", brushed(dielectric(white, 0.1F, 1.5F, 0), 1)},
      {"brushed_glass", brushed(dielectric(white, 0.1F, 1.5F, 1), 0.3F)},
      {"soap_plastic", filmed(dielectric(white, 0.2F, 1.5F, 0), 1, 400)},
      {"soap_glass", filmed(dielectric(white, 0.2F, 1.5F, 1), 0.8F, 300)},
      {"soap_metal", filmed(metal(orange, 0.2F), 1, 500)},
      {"lambert_white", lambert(white)},
      {"lambert_orange", lambert(orange)},
      {"black", lambert(black)},
      {"metal_alpha_1", metal(white, 1)},
      {"metal_alpha_03", metal(orange, 0.3F)},
      {"metal_alpha_001", metal(orange, 0.01F)},
      {"metal_alpha_min", metal(white, ggx_min_alpha)},
      {"metal_smooth", metal(orange, 0)},
      {"mirror", layer(lambert(white), white, 1)},
      {"plastic_alpha_1", dielectric(white, 1, 1.5F, 0)},
      {"plastic_alpha_02", dielectric(orange, 0.2F, 1.5F, 0)},
      {"plastic_smooth", dielectric(white, 0, 1.5F, 0)},
      {"plastic_black_base", dielectric(black, 0.1F, 1.5F, 0)},
      {"grazing_only", layer(dielectric(black, 0.3F, 1.5F, 0), black, 1)},
      {"plastic_ior_1", dielectric(white, 0.5F, 1, 0)},
      {"plastic_ior_15", dielectric(white, 0.3F, 15, 0)},
      {"plastic_dimmed", layer(dielectric(white, 0.25F, 1.5F, 0), {0.3F, 0.1F, 0}, 0.5F)},
      {"half_metal", mixed(dielectric(orange, 0.25F, 1.5F, 0), 0.5F)},
      {"glass_smooth", dielectric(white, 0, 1.5F, 1)},
      {"glass_alpha_1", dielectric(white, 1, 1.5F, 1)},
      {"glass_alpha_02", dielectric(orange, 0.2F, 1.5F, 1)},
      {"glass_alpha_0003", dielectric(white, 0.003F, 1.33F, 1)},
      {"glass_ior_15", dielectric(white, 0.1F, 15, 1)},
      {"glass_ior_1", dielectric(orange, 0.5F, 1, 1)},
      {"glass_ior_nearly_1", dielectric(white, 0.3F, 1.0002F, 1)},
      {"glass_ior_105", dielectric(white, 0.5F, 1.05F, 1)},
      {"glass_tinted", layer(dielectric(white, 0.3F, 1.5F, 1), {0.1F, 0.04F, 0}, 0.6F)},
      {"glass_no_layer", layer(dielectric(white, 0.3F, 1.5F, 1), black, 0)},
      {"half_glass", dielectric(orange, 0.2F, 1.5F, 0.5F)},
      {"half_glass_smooth", dielectric(orange, 0, 1.5F, 0.5F)},
      {"half_clear", mixed(dielectric(orange, 0.3F, 1, 0.5F), 0.25F)},
  };
  for (Surface& s : exact_surfaces()) all.push_back(std::move(s));
  return all;
}

struct View {
  std::string name;
  V3f ng, ns, wo;

  bool flat() const { return ng == ns; }
};

inline std::vector<View> views() {
  const V3f ng = view_normal();
  const V3f slightly = direction(ng, 0.95F, 0.4F);
  const V3f strongly = direction(ng, 0.5F, 0.4F);
  return {
      {"normal", ng, ng, ng},
      {"oblique", ng, ng, direction(ng, 0.6F, 1)},
      {"grazing", ng, ng, direction(ng, 0.05F, 2)},
      {"nearly_parallel", ng, ng, direction(ng, 1e-3F, 2)},
      {"inside", ng, ng, direction(ng, -0.9F, 1)},
      {"inside_beyond_critical", ng, ng, direction(ng, -0.5F, 1)},
      {"slightly_tilted", ng, slightly, direction(ng, 0.5F, -0.7F)},
      {"slightly_tilted_inside", ng, slightly, direction(ng, -0.8F, 2)},
      {"strongly_tilted", ng, strongly, direction(ng, 0.8F, 1.2F)},
      {"behind_ns", ng, strongly, direction(ng, 0.3F, 0.4F + 3)},
      {"behind_ns_inside", ng, strongly, direction(ng, -0.3F, 0.4F)},
  };
}

inline Rng rng(std::uint64_t stream) { return Rng(20, stream, 0, Rng::Purpose::test); }

/// Uniform on the sphere.
inline V3f uniform_direction(Rng& random) {
  const float z = 2 * random.next() - 1;
  const float phi = 2 * pi * random.next();
  const float r = std::sqrt(std::max(0.0F, 1 - z * z));
  return {r * std::cos(phi), r * std::sin(phi), z};
}

inline std::optional<BsdfSample> sample(const Bsdf& bsdf, const V3f& wo, Rng& random,
                                        Transport transport) {
  const float u_lobe = random.next();
  return bsdf.sample(wo, u_lobe, random.next2(), transport);
}

}  // namespace lacuna::cases
