#pragma once

#include <cstdint>
#include <optional>

#include "renderer/core/boxed.h"
#include "renderer/core/vec.h"
#include "renderer/geometry/medium.h"
#include "renderer/materials/coating.h"
#include "renderer/materials/covers.h"
#include "renderer/materials/interface.h"
#include "renderer/materials/layer.h"

namespace lacuna {

/// The parameters of the glTF surface model at one point, after texture lookups.
struct SurfaceParams {
  Rgb base_color{1, 1, 1};
  float metallic = 0;           ///< [0, 1]
  float alpha = 1;              ///< GGX width, roughness^2; below ggx_min_alpha: smooth, a delta
  float ior = 1.5F;             ///< >= 1; of the inside
  Rgb f0{0.04F, 0.04F, 0.04F};  ///< dielectric reflectance at normal incidence
  float f90 = 1;
  float transmission = 0;  ///< [0, 1]: transmitting fraction of the dielectric's base
  bool solid = false;      ///< transmitted light is refracted into a solid; else a thin wall
  const Medium* medium = nullptr;  ///< in the solid; null: none
  float diffuse_transmission = 0;  ///< [0, 1]: share of Lambert's lobe on the other side
  Rgb diffuse_transmission_color{1, 1, 1};
  Rgb sheen_color{0, 0, 0};
  float sheen_alpha = 0;  ///< [0, 1]
  float coat = 0;         ///< [0, 1]
  float coat_alpha = 0;   ///< [0, 1]
  float alpha_along = 0;  ///< GGX width along `direction`, >= alpha; 0: the facets are isotropic
  V2f direction{1, 0};    ///< unit, in the tangent frame
  ThinFilm film = {};
  std::optional<V3f> coat_normal = {};     ///< unit, in scene coordinates; none: that of the base
  std::optional<ExactSurface> exact = {};  ///< replaces the lobes of all but base_color and medium
};

/// The lobes that few materials have.
struct FurtherLobes {
  Rgb diffuse_through{0, 0, 0};  ///< Lambert's lobe on the other side: share times colour
  Covers covers;
  std::optional<V3f> coat_normal;  ///< as in SurfaceParams; such a coat is rough
  float alpha_along = 0;           ///< as in SurfaceParams; above 0 if `shape` is not glTF's
  V2f direction{1, 0};
  FacetShape shape = FacetShape::ggx;
  float sigma = 0;         ///< of a rough diffuse base (oren_nayar.h); 0: Lambert
  bool one_sided = false;  ///< the back is black
  Rgb scale{1, 1, 1};      ///< of all lobes
  std::optional<Coating> coating;

  /// Whether the facets, across of `alpha`, or those of the coating have two widths.
  bool two_widths(float alpha) const {
    return (alpha_along > 0 && alpha_along != alpha) || (coating && coating->two_widths());
  }
};

/// The scattering of a surface without its normals. Computed once for all hits if the material has
/// no textures.
struct Lobes {
  enum class Kind : std::uint8_t { black, lambert, layered };

  // Implicit: both types describe the same surface.
  Lobes(const SurfaceParams& params)
      : diffuse(((1 - params.metallic) * (1 - params.transmission)) * params.base_color) {
    if (params.exact) [[unlikely]] {
      make_exact(params);
    } else if (params.metallic > 0 || params.transmission > 0 || params.f90 > 0 ||
               !is_black(params.f0) || has_further(params)) {
      add_interface(params);
    } else {
      kind = is_black(diffuse) ? Kind::black : Kind::lambert;
    }
  }
  /// A Lambertian surface.
  explicit Lobes(const Rgb& albedo)
      : diffuse(albedo), kind(is_black(albedo) ? Kind::black : Kind::lambert) {}

  bool has_diffuse() const { return !is_black(diffuse); }
  /// Whether other lobes than the facets must be sampled, too.
  bool facets_compete() const {
    return has_diffuse() || (interface.glass > 0 && interface.clear()) || further;
  }
  bool facets_transmit() const { return interface.glass > 0 && !interface.clear(); }

  Rgb diffuse;  ///< share of Lambert times base colour
  Kind kind = Kind::layered;
  Layer layer;  ///< used if facets_compete()
  Interface interface;
  const Medium* medium = nullptr;  ///< behind the surface
  Boxed<FurtherLobes> further;

 private:
  static bool has_further(const SurfaceParams& p) {
    return p.coat > 0 || p.diffuse_transmission > 0 || !is_black(p.sheen_color);
  }
  void add_interface(const SurfaceParams& params);
  void add_further(const SurfaceParams& params);
  void make_exact(const SurfaceParams& params);
  void make_base(const SurfaceParams& params);
};

/// The lobes at a hit: those of a uniform material, which all its hits share, or its own.
class HeldLobes {
 public:
  explicit HeldLobes(const Lobes& shared) : lobes_(&shared) {}
  template <class Surface>
  explicit HeldLobes(const Surface& own) : lobes_(&own_.emplace(own)) {}
  HeldLobes(const HeldLobes& o) : own_(o.own_), lobes_(own_ ? &*own_ : o.lobes_) {}
  HeldLobes& operator=(const HeldLobes& o) {
    own_ = o.own_;
    lobes_ = own_ ? &*own_ : o.lobes_;
    return *this;
  }
  ~HeldLobes() = default;

  const Lobes* operator->() const { return lobes_; }
  const Lobes& operator*() const { return *lobes_; }

 private:
  std::optional<Lobes> own_;
  const Lobes* lobes_;
};

}  // namespace lacuna
