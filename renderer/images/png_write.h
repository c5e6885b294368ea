#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace lacuna {

/// Encodes sRGB codes as a PNG: `rgb` is interleaved, top row first, 3 x width x height. Equal
/// pictures give equal bytes. Throws std::runtime_error.
std::string encode_png(int width, int height, std::span<const std::uint8_t> rgb);

}  // namespace lacuna
