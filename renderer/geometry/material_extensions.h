#pragma once

#include "renderer/core/vec.h"
#include "renderer/geometry/medium.h"
#include "renderer/geometry/texture_ref.h"

namespace lacuna {

// What a material has of glTF's extensions KHR_materials_*. Factors are linear, in [0, 1] where
// nothing else is said, and multiply the named channel of their texture, linear unless it is said
// to be sRGB.

/// KHR_materials_volume. Without it transmission is that of a thin wall.
struct Volume {
  bool solid = false;  ///< thicknessFactor > 0: transmitted light is refracted into a solid
  Medium inside = {};  ///< attenuationColor and attenuationDistance

  bool operator==(const Volume&) const = default;
};

/// KHR_materials_diffuse_transmission.
struct DiffuseTransmission {
  float factor = 0;
  TextureRef texture = {};  ///< A
  Rgb color{1, 1, 1};
  TextureRef color_texture = {};  ///< sRGB

  bool operator==(const DiffuseTransmission&) const = default;
};

/// KHR_materials_clearcoat.
struct ClearCoat {
  float factor = 0;
  TextureRef texture = {};  ///< R
  float roughness = 0;
  TextureRef roughness_texture = {};  ///< G
  bool own_normal = false;            ///< its normal is not that of the base
  TextureRef normal_texture = {};     ///< as Material::normal_texture, if own_normal
  float normal_scale = 1;

  bool operator==(const ClearCoat&) const = default;
};

/// KHR_materials_sheen.
struct SheenLayer {
  Rgb color{0, 0, 0};
  TextureRef color_texture = {};  ///< sRGB
  float roughness = 0;
  TextureRef roughness_texture = {};  ///< A

  bool operator==(const SheenLayer&) const = default;
};

/// KHR_materials_anisotropy.
struct Anisotropy {
  float strength = 0;
  float rotation = 0;       ///< radians, counter-clockwise from the tangent
  TextureRef texture = {};  ///< R and G: a direction from -1 to 1; B: strength

  bool operator==(const Anisotropy&) const = default;
};

/// KHR_materials_iridescence.
struct Iridescence {
  float factor = 0;
  TextureRef texture = {};               ///< R
  float ior = 1.3F;                      ///< of the film, >= 1
  float thinnest = 100, thickest = 400;  ///< nm, >= 0; the latter without a texture
  TextureRef thickness_texture = {};     ///< G: from thinnest to thickest

  bool operator==(const Iridescence&) const = default;
};

/// All of them.
struct MaterialExtensions {
  Volume volume;
  DiffuseTransmission diffuse_transmission;
  ClearCoat coat;
  SheenLayer sheen;
  Anisotropy anisotropy;
  Iridescence iridescence;

  bool operator==(const MaterialExtensions&) const = default;

  template <class F>
  void for_each_texture(F&& f) const {
    for (const TextureRef* t : {&diffuse_transmission.texture, &diffuse_transmission.color_texture,
                                &coat.texture, &coat.roughness_texture, &coat.normal_texture,
                                &sheen.color_texture, &sheen.roughness_texture, &anisotropy.texture,
                                &iridescence.texture, &iridescence.thickness_texture}) {
      if (t->used()) f(*t);
    }
  }
};

}  // namespace lacuna
