#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lacuna {

/// Codes of 8 bits, interleaved, top row first.
struct CodePicture {
  int width = 0, height = 0, channels = 3;  ///< 3: RGB, 4: RGB and alpha
  std::vector<std::uint8_t> codes;
};

/// A Truevision TGA of grey, 24 or 32 bits, plain or run-length encoded, up to max_texture_side.
/// Throws SceneError with `label` for others and where the bytes end early.
CodePicture read_tga(std::span<const std::uint8_t> bytes, const std::string& label);

}  // namespace lacuna
