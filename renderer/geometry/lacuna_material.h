#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/core/vec.h"
#include "renderer/geometry/facet_shape.h"
#include "renderer/geometry/texture_ref.h"

namespace lacuna {

struct Material;

/// The glTF extension LACUNA_materials: surfaces that glTF's own model cannot express
/// (docs/materials.md). Replaces the lobes of the material, except for its base colour, which is
/// the diffuse reflectance. Factors are linear and multiply the named channel of their texture.
struct LacunaMaterial {
  enum class Type : std::uint8_t {
    diffuse,
    conductor,
    dielectric,
    thin_dielectric,
    plastic,
    glossy,   ///< Phong's and Ward's lobes over a Lambertian base
    coating,  ///< a dielectric layer over parts[0]
    mixture,  ///< of its parts
  };
  struct Part {
    std::shared_ptr<const Material> material;  ///< not null
    Rgb weight{1, 1, 1};                       ///< [0, 1]

    bool operator==(const Part&) const = default;
  };

  Type type = Type::diffuse;
  bool one_sided = false;  ///< the back is black
  bool nonlinear = false;  ///< plastic: inner reflections tint the base
  float sigma = 0;         ///< diffuse: standard deviation of the facets' slope angles, radians
  FacetShape shape = FacetShape::ggx_separable;
  V2f alpha{0, 0};               ///< widths along u and across, [0, 1]; below ggx_min_alpha: smooth
  TextureRef alpha_texture;      ///< R
  float ior = 1.5F;              ///< of the inside over that of the outside, above 0
  Rgb eta{1, 1, 1}, k{0, 0, 0};  ///< conductor: complex index of refraction over the outside's
  Rgb reflectance{1, 1, 1};      ///< scale of what is reflected; glossy: the reflectance itself
  TextureRef reflectance_texture;  ///< sRGB
  Rgb transmittance{1, 1, 1};      ///< scale of what is transmitted
  Rgb optical_depth{0, 0, 0};      ///< coating: thickness times absorption, of the straight way
  std::vector<Part> parts;
  TextureRef weight_texture;  ///< R: the share of the second of two parts, the rest of the first
  TextureRef bump;            ///< R: height
  float bump_scale = 1;       ///< scene units

  bool operator==(const LacunaMaterial&) const = default;

  /// Calls `f` with each texture that the lobes depend on, also those of the parts.
  template <class F>
  void for_each_texture(F&& f) const;
  /// Whether points of the surface have different parts.
  bool chooses() const { return type == Type::mixture || (!parts.empty() && part_chooses()); }
  bool transmits() const { return type == Type::dielectric || type == Type::thin_dielectric; }

 private:
  bool part_chooses() const;
};

}  // namespace lacuna
