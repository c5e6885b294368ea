#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace lacuna {

/// Encodes a PNG: `values` are codes of 8 bits, interleaved, top row first, 3 x width x height
/// (RGB) or 4 x width x height (RGBA, alpha not multiplied in). Equal pictures give equal bytes.
/// Throws std::runtime_error.
std::string encode_png(int width, int height, std::span<const std::uint8_t> values);

}  // namespace lacuna
