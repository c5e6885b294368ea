#pragma once

#include <filesystem>
#include <span>

namespace lacuna {

/// Writes a PNG to look at: exposed so that the 95th percentile of luminance becomes 0.8 of white,
/// clipped, sRGB. Values below zero or not finite show as black. `rgb` is interleaved, top row
/// first. Throws as write_exr does.
void write_preview(const std::filesystem::path& file, int width, int height,
                   std::span<const double> rgb);

}  // namespace lacuna
