#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lacuna {

/// An image as its file stores it, 8 bits a channel, alpha not multiplied in, top row first.
struct Rgba8Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

/// Decodes a PNG or JPEG, told by its magic bytes. Throws SceneError with `label`.
Rgba8Image decode_png_or_jpeg(std::span<const std::uint8_t> encoded, const std::string& label);

}  // namespace lacuna
