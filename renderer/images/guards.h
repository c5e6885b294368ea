#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lacuna {

// Validates untrusted files before the library decodes them. Each guard parses a file's structure
// without decoding it, and throws SceneError with the file's name if it is truncated, of an
// unsupported size, depth or kind, or inconsistent with its length.
//
// Guards of files in memory return the bytes to decode: the same image reduced to its pixels.
// Profiles, comments, thumbnails and camera data never reach the library.

constexpr int max_picture_side = 32768;  ///< pixels
constexpr int max_texture_side = 16384;  ///< texels
/// Limit of the decoded texels of all textures of a scene together: 2 GiB at 4 bytes per texel.
constexpr std::uint64_t max_scene_texels = std::uint64_t{1} << 29;
/// Limit of the encoded bytes of all textures of a scene together (gltf::TextureTable).
constexpr std::uint64_t max_encoded_bytes = std::uint64_t{2} << 30;

/// Validates the headers of an OpenEXR file. The libraries trust them: they allocate memory for any
/// stated number of attributes, rows and tiles before they read them, and an unknown channel type
/// aborts the process. Allowed: flat parts of up to max_picture_side with all channels at full
/// resolution, and RGB with the primaries of Rec. 709.
void check_exr_header(std::span<const std::uint8_t> exr, const std::string& label);

/// A PNG of up to 16 bits and max_texture_side, of any colour type.
std::vector<std::uint8_t> plain_png(std::span<const std::uint8_t> png, const std::string& label);

/// A JPEG of 8 bits, grey or three colours, in at most 500 scans, up to max_texture_side.
std::vector<std::uint8_t> plain_jpeg(std::span<const std::uint8_t> jpeg, const std::string& label);

/// A still WebP, lossy or lossless, up to max_texture_side (WebP itself ends at 16383). Without
/// alpha: the same colours, as an image that has none.
std::vector<std::uint8_t> plain_webp(std::span<const std::uint8_t> webp, const std::string& label,
                                     bool alpha);
/// Whether the bytes begin as those of a WebP.
bool is_webp(std::span<const std::uint8_t> bytes);

/// The number of texels, from the header of a PNG, WebP or TIFF or the frame header of a JPEG. Does
/// not validate the rest of the file.
std::uint64_t png_texels(std::span<const std::uint8_t> png, const std::string& label);
std::uint64_t jpeg_texels(std::span<const std::uint8_t> jpeg, const std::string& label);
std::uint64_t webp_texels(std::span<const std::uint8_t> webp, const std::string& label);
std::uint64_t tiff_texels(std::span<const std::uint8_t> tiff, const std::string& label);

/// A Radiance picture to decode, and the factors that its header states for each channel.
struct PlainHdr {
  std::vector<std::uint8_t> bytes;
  std::array<double, 3> multiplied{1, 1, 1};  ///< product of all EXPOSURE and COLORCORR lines
};

/// A Radiance picture (`32-bit_rle_rgbe`, also the default without FORMAT; top row first) up to
/// max_picture_side, with rows flat or channel by channel. Rows in the old run-length encoding,
/// which the library does not support, are expanded. PRIMARIES may be Radiance's or those of Rec.
/// 709.
PlainHdr plain_hdr(std::span<const std::uint8_t> hdr, const std::string& label);

/// CIE xy of red, green, blue and white.
using Chromaticities = std::array<double, 8>;
/// ITU-R BT.709-6, items 1.3 and 1.4: the RGB of Lacuna and of glTF.
inline constexpr Chromaticities rec709{.64, .33, .30, .60, .15, .06, .3127, .3290};
/// Whether all coordinates agree to .002, as values written with three digits do.
bool are_close(const Chromaticities& a, const Chromaticities& b);
/// "0.64 0.33 0.3 ...", as in errors.
std::string chromaticities_text(const Chromaticities& xy);

/// The first picture of a TIFF of up to 4 GiB and max_picture_side: 1, 3 or 4 channels of 16- or
/// 32-bit floats, uncompressed or compressed by LZW, Deflate or PackBits.
std::vector<std::uint8_t> plain_tiff(std::span<const std::uint8_t> tiff, const std::string& label);
/// The first picture of a TIFF up to max_texture_side: 1 to 4 channels of unsigned integers of 8 or
/// 16 bits, compressed as above, top row first, with alpha that is not multiplied in.
std::vector<std::uint8_t> plain_tiff_texture(std::span<const std::uint8_t> tiff,
                                             const std::string& label);

}  // namespace lacuna
