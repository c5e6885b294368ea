#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "renderer/core/huge_pages.h"

namespace lacuna {

/// An image as stored, 8 bits per channel, alpha not multiplied in, top row first.
struct Rgba8Image {
  int width = 0, height = 0;
  HugeVector<std::uint8_t> rgba;  ///< 4 x width x height
};

/// The number of texels of a PNG, JPEG, WebP or TIFF, from its header. Throws SceneError with
/// `label`.
std::uint64_t texels_of_texture(std::span<const std::uint8_t> encoded, const std::string& label);

/// Decodes a PNG, JPEG, WebP or TIFF, by its magic bytes, of up to 16384 texels a side. 16 bits are
/// rounded to 8, grey becomes RGB, missing alpha becomes 255; gamma and profiles are ignored, as
/// glTF requires. Throws SceneError with `label`; std::runtime_error if the image module is
/// missing.
Rgba8Image decode_texture(std::span<const std::uint8_t> encoded, const std::string& label);

}  // namespace lacuna
