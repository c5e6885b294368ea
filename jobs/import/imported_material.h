#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/core/vec.h"

namespace lacuna {

/// A picture, or a pattern that the importer bakes into one.
struct ImportedTexture {
  enum class Wrap { repeat, mirror, clamp };
  std::string place;
  std::filesystem::path file;  ///< empty: a checkerboard of `odd` and `even`
  bool srgb = true;            ///< the file's values are encoded by sRGB's curve
  double gamma = 1;            ///< if not srgb: linear = value^gamma
  std::optional<int> channel;  ///< only this one: 0 to 3 are red, green, blue, alpha
  std::array<Wrap, 2> wrap{Wrap::repeat, Wrap::repeat};  ///< u, v
  bool nearest = false;
  bool inverted = false;  ///< 1 - value, after decoding
  /// uv of the picture = scale * uv of the mesh + offset; v upwards in both.
  V2d scale{1, 1}, offset{0, 0};
  Rgb even{0.4F, 0.4F, 0.4F}, odd{0.2F, 0.2F, 0.2F};  ///< linear; 2 x 2 squares in the unit square
  bool operator==(const ImportedTexture&) const = default;
};

/// A colour (linear) or a number (its red), times a texture if there is one.
struct ImportedValue {
  Rgb value{1, 1, 1};
  std::shared_ptr<const ImportedTexture> texture;
};

/// A BSDF in the terms of the extension LACUNA_materials (docs/scenes.md), which has the meaning
/// of each field. Fields that a type does not name are not used.
struct ImportedMaterial {
  enum class Type {
    diffuse,
    conductor,
    dielectric,
    thin_dielectric,
    plastic,
    phong,
    ward,
    coating,
    mixture,
    diffuse_transmission,  ///< Lambert's lobe on the other side, of colour `transmittance`
    black,                 ///< absorbs all light: that of an emitter without a BSDF
    standard,              ///< glTF's own: `diffuse` as base colour, metallic, roughness, ...
  };
  struct Part {
    std::shared_ptr<const ImportedMaterial> material;
    Rgb weight{1, 1, 1};
  };

  std::string name, place;
  Type type = Type::diffuse;
  bool one_sided = false;  ///< the back is black
  ImportedValue diffuse{{0.5F, 0.5F, 0.5F}, nullptr};
  bool vertex_colors = false;  ///< the colours of its meshes are meant; else they have none
  double sigma = 0;            ///< of Oren-Nayar's facets, radians

  bool beckmann = false;
  bool correlated_masking = false;    ///< of GGX: masking and shadowing correlate by height
  std::array<double, 2> alpha{0, 0};  ///< along u and across; 0: smooth
  std::shared_ptr<const ImportedTexture> alpha_texture;
  Rgb eta{1, 1, 1}, k{0, 0, 0};  ///< of a conductor, relative to the outside
  double ior = 1.5;              ///< inside over outside
  ImportedValue reflectance, transmittance;
  bool nonlinear = false;
  double exponent = 30;
  std::string ward_variant = "balanced";

  double thickness = 0;     ///< of a coating, scene units
  Rgb absorption{0, 0, 0};  ///< of a coating, or of a solid's inside, per scene unit
  /// Of a mixture; the one base of a coating.
  std::vector<Part> parts;
  std::shared_ptr<const ImportedTexture> weight_texture;  ///< weight of the second of two parts

  ImportedValue opacity;  ///< alpha; any type
  std::shared_ptr<const ImportedTexture> normal_map, bump_map;
  double bump_scale = 1;  ///< scene units at white

  // Type::standard
  double metallic = 0, roughness = 1, specular = 1, transmission = 0;
  std::shared_ptr<const ImportedTexture> roughness_texture, metallic_texture;
  bool thin = false;  ///< what it transmits goes straight on
  double coat = 0, coat_roughness = 0;
  Rgb sheen{0, 0, 0};
  double anisotropy = 0;
};

}  // namespace lacuna
