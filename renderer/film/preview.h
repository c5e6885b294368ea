#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace lacuna {

/// The factor that takes the 95th percentile of luminance to 0.8; 1 for a picture without light.
double preview_exposure(std::span<const double> rgb);

/// The sRGB code of a linear value; of what is not above 0, or not a number, 0.
unsigned char display_code(double linear);

/// The bytes of a PNG: `rgb` times `exposure`, clipped, sRGB. Values below zero or not finite show
/// as black. `rgb` is interleaved, top row first. Throws std::runtime_error.
std::string preview_png(int width, int height, std::span<const double> rgb, double exposure);

/// Writes a PNG to look at: preview_png() with its own exposure. Throws as write_exr does.
void write_preview(const std::filesystem::path& file, int width, int height,
                   std::span<const double> rgb);

}  // namespace lacuna
