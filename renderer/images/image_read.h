#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/storage/input_file.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// Linear RGB pixels, top row first.
struct FloatImage {
  int width = 0, height = 0;
  std::vector<float> rgb;  ///< 3 x width x height
  /// String attributes of its header whose names begin with "lacuna:".
  std::map<std::string, std::string> attributes;
  InputFile file = {};                    ///< size and hash of the file
  std::optional<float> least_alpha = {};  ///< if it has a channel A beside its colours

  /// Pixel (x, y), 0 <= x < width, 0 <= y < height.
  Rgb at(int x, int y) const {
    const auto i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                        static_cast<std::size_t>(x));
    return {rgb[i], rgb[i + 1], rgb[i + 2]};
  }
};

/// Reads an OpenEXR, Radiance HDR or PFM file, by its magic bytes, of up to 32768 pixels a side.
/// `layer` selects the channels of an EXR: "half_a" means half_a.R, half_a.G, half_a.B and so on;
/// empty means R, G, B, or X, Y, Z (CIE 1931), converted to linear RGB of Rec. 709, or Y as grey.
/// Values of Radiance HDR are divided by the EXPOSURE and COLORCORR of its header. Otherwise values
/// are unchanged, including non-finite ones. Throws SceneError for a missing file or layer, another
/// format, other primaries, and files that are corrupt, deep or a crop of a larger image;
/// InputUnreadable if it cannot be read now; std::system_error (ELIBACC) if the image module is
/// missing.
FloatImage read_float_image(const std::filesystem::path& file, const std::string& layer = "");

/// Reads a reference image, which may also be a TIFF of floats.
FloatImage read_reference_image(const std::filesystem::path& file, const std::string& layer = "");

/// Decodes a PFM of one or three channels in either byte order, times the absolute value of its
/// scale, of up to 32768 pixels a side. Throws SceneError with `label`.
FloatImage read_pfm(std::span<const std::uint8_t> bytes, const std::string& label);

/// Throws SceneError if a value is negative or not finite, which radiance cannot be, with `label`,
/// the position and value of the first such pixel, and the number of such values.
void require_radiance(const FloatImage& image, const std::string& label);
/// Throws SceneError in the same way, only for values that are not finite.
void require_finite(const FloatImage& image, const std::string& label);

}  // namespace lacuna
