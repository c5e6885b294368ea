#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace lacuna {

/// The exposure that maps the 95th percentile of luminance to 0.8; 1 for a black picture.
double preview_exposure(std::span<const double> rgb);

/// The sRGB code of a linear value; 0 for values <= 0 and NaN.
unsigned char display_code(double linear);

/// The bytes of a PNG: `rgb` times `exposure`, clipped, sRGB. Negative and non-finite values become
/// black. `rgb` is interleaved, top row first. Throws std::runtime_error.
std::string preview_png(int width, int height, std::span<const double> rgb, double exposure);

/// Writes preview_png() at preview_exposure(). Throws like write_exr().
void write_preview(const std::filesystem::path& file, int width, int height,
                   std::span<const double> rgb);

}  // namespace lacuna
