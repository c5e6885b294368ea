#pragma once

#include "renderer/core/vec.h"

namespace lacuna {

/// A material's reference to a texture: image, coordinates and KHR_texture_transform.
struct TextureRef {
  int texture = -1;  ///< index into SceneData::textures; -1: no texture, only the factor
  int uv_set = 0;
  V2f offset{0, 0};
  V2f scale{1, 1};
  float rotation = 0;  ///< radians, counter-clockwise as glTF defines it

  bool used() const { return texture >= 0; }
  V2f transform(const V2f& uv) const;
  bool operator==(const TextureRef&) const = default;
};

}  // namespace lacuna
