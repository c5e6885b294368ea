#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "renderer/core/huge_pages.h"

namespace lacuna {

/// An image as its file stores it, 8 bits a channel, alpha not multiplied in, top row first.
struct Rgba8Image {
  int width = 0, height = 0;
  HugeVector<std::uint8_t> rgba;  ///< 4 x width x height
};

/// The number of texels of a PNG or JPEG, by its header. Throws SceneError with `label`.
std::uint64_t texels_of_png_or_jpeg(std::span<const std::uint8_t> encoded,
                                    const std::string& label);

/// Decodes a PNG or JPEG, by its magic bytes, of up to 16384 texels a side. 16 bits are
/// rounded to 8, grey becomes RGB, no alpha becomes 255; gamma and profiles are left aside, as glTF
/// asks. Throws SceneError with `label`; std::runtime_error if the module of images is missing.
Rgba8Image decode_png_or_jpeg(std::span<const std::uint8_t> encoded, const std::string& label);

}  // namespace lacuna
