#pragma once

#include <filesystem>

#include "renderer/scene/image_read.h"

namespace lacuna {

/// Reads a Radiance picture (`32-bit_rle_rgbe`, flat or run-length encoded, top row first): its
/// pixels as they are, without its EXPOSURE. Strict, because lenient readers fill what a cut file
/// lacks. `max_side`: pixels. Throws SceneError.
FloatImage read_radiance_hdr(const std::filesystem::path& file, int max_side);

}  // namespace lacuna
