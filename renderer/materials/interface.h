#pragma once

#include "renderer/materials/exact_surface.h"
#include "renderer/materials/ggx.h"
#include "renderer/materials/specular.h"
#include "renderer/materials/thin_film.h"

namespace lacuna {

struct SurfaceParams;

/// The specular boundary of the glTF surface. One distribution of facets, of width `alpha`, models
/// - the metal: Schlick from the base colour to white,
/// - the layer over the opaque dielectric: Schlick from f0 to f90,
/// - the boundary of the transmissive dielectric: exact Fresnel, remapped from its own range to
///   [f0, f90] so that KHR_materials_specular tints and dims it.
/// A film replaces a share of all three reflectances by its own. For LACUNA_materials, one of the
/// exact reflectances of `Exact` stands in place of all of these.
///
/// The transmissive dielectric is the boundary of a solid whose outside is the front of ng, or a
/// thin wall: both sides are outside, and light that passes goes on as if it were reflected and
/// then mirrored to the other side (KHR_materials_transmission).
struct Interface {
  Interface() = default;
  explicit Interface(const SurfaceParams& params);
  /// Of a surface that is not Base::gltf.
  explicit Interface(const ExactSurface& surface);

  /// Reflectance and transmittance of a facet for light at `cos`; `eta` as in specular.h.
  struct Split {
    Rgb reflected{0, 0, 0};
    Rgb transmitted{0, 0, 0};  ///< without the 1 / eta^2 of radiance
  };
  Split split(float cos, float eta) const {
    if (exact_ != Exact::none) [[unlikely]]
      return exact_split(cos, eta);
    const Rgb white(1, 1, 1);
    Split result{r0 + (r90 * white - r0) * schlick_weight(cos), Rgb(0, 0, 0)};
    float outside = cos;
    if (glass > 0) {
      const Fresnel exact = fresnel_dielectric(cos, eta);
      const Rgb f = exact.total ? white : remap(exact.reflectance);
      result.reflected += glass * f;
      result.transmitted = (1 - max_component(f)) * glass_color;
      if (exact.total) return result;
      if (eta < 1) outside = exact.cos_t;
    }
    if (film.strength > 0) add_film(outside, result);
    return result;
  }

  bool smooth() const { return alpha == 0; }
  /// Whether split() is exact for one of LACUNA_materials' surfaces.
  bool exact() const { return exact_ != Exact::none; }
  /// Whether transmission is not scattered although the facets are rough: its spread, about alpha
  /// (ior - 1), is below ggx_min_alpha.
  bool clear() const { return !smooth() && !thin && alpha * std::abs(ior - 1) < ggx_min_alpha; }
  /// eta of Fresnel's equations for light from the front or back side.
  float eta(bool front) const { return thin || front ? ior : 1 / ior; }
  /// eta of the light's direction and radiance: 1 if light that passes is not refracted.
  float bend(bool front) const { return thin ? 1 : eta(front); }

  Rgb r0{0, 0, 0};  // of metal and opaque dielectric, weighted by their shares, at normal incidence
  float r90 = 0;    // the same at grazing incidence
  float alpha = 0;
  float glass = 0;           // share of the transmissive dielectric
  Rgb glass_color{0, 0, 0};  // that share times the base colour
  Rgb glass_f0{0, 0, 0};
  float glass_f90 = 0;
  float ior = 1;
  bool thin = true;  ///< light that passes is not refracted
  ThinFilm film;

 private:
  /// Constant; exact Fresnel of a conductor, of a dielectric over an opaque base, of the boundary
  /// of a solid, of a pane with all its inner reflections.
  enum class Exact : std::uint8_t { none, constant, conductor, opaque, solid, pane };

  Split exact_split(float cos, float eta) const;
  Rgb remap(float reflectance) const {
    const float t = (reflectance - exact_f0_) * inv_range_;
    const auto channel = [&](float low) {
      return std::clamp(low + (glass_f90 - low) * t, 0.0F, 1.0F);
    };
    return {channel(glass_f0.x), channel(glass_f0.y), channel(glass_f0.z)};
  }

  /// Blends the film's reflectance for light at cosine `outside` into `of`.
  void add_film(float outside, Split& of) const;

  float exact_f0_ = 0,
        inv_range_ = 1;  // remaps exact Fresnel: 1 / (1 - its value at normal incidence)
  // Of the film's bases: shares, and reflectances at normal incidence.
  float metallic_ = 0, opaque_ = 0, f90_ = 0;
  Rgb metal_f0_{0, 0, 0}, f0_{0, 0, 0};
  Exact exact_ = Exact::none;
  Rgb reflectance_{1, 1, 1}, eta_{1, 1, 1}, k_{0, 0, 0};  // as in ExactSurface
};

}  // namespace lacuna
