#pragma once

#include <vector>

#include "jobs/import/imported_material.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// Linear RGB, top row first.
struct LinearPicture {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;

  const Rgb& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

/// Whether the file is one of float values (EXR, Radiance HDR, PFM), by its name.
bool is_float_picture(const std::filesystem::path& file);

/// Decodes a texture's picture: EXR, HDR and PFM, or PNG, JPEG, WebP, TIFF and TGA of up to 8 bits
/// a channel, by sRGB's curve or `gamma`; a single channel becomes grey. A checkerboard is baked at
/// 512 x 512. Throws SceneError with the texture's place.
LinearPicture linear_picture(const ImportedTexture& texture);

/// The same picture with as many pixels as `width` x `height`: bilinear, repeated at the borders.
LinearPicture resized(const LinearPicture& picture, int width, int height);

/// As 8-bit codes of sRGB, interleaved; values are divided by `scale` and clipped to [0, 1].
std::vector<std::uint8_t> srgb_codes(const LinearPicture& picture, double scale);
/// As 8-bit linear codes.
std::vector<std::uint8_t> linear_codes(const LinearPicture& picture);

}  // namespace lacuna
