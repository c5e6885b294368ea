#include "renderer/images/texture_decode.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "renderer/core/scene_error.h"
#include "renderer/images/guards.h"
#include "renderer/images/image_module.h"

namespace lacuna {
namespace {

/// v / 257, rounded.
std::uint8_t to_8_bits(std::uint16_t v) {
  return static_cast<std::uint8_t>((std::uint32_t{v} * 255 + 32895) >> 16);
}

/// Value `i` of `texels`, in 8 bits.
std::uint8_t value_at(const StoredTexels& texels, std::size_t i) {
  if (texels.bits == 8) return texels.values[i];
  std::uint16_t value = 0;
  std::memcpy(&value, texels.values.get() + 2 * i, sizeof value);
  return to_8_bits(value);
}

Rgba8Image to_rgba(const StoredTexels& texels) {
  const auto pixels =
      static_cast<std::size_t>(texels.width) * static_cast<std::size_t>(texels.height);
  const auto channels = static_cast<std::size_t>(texels.channels);
  const bool grey = channels < 3, alpha = channels % 2 == 0;
  Rgba8Image image{texels.width, texels.height, HugeVector<std::uint8_t>(4 * pixels)};
  for (std::size_t i = 0; i < pixels; ++i) {
    std::uint8_t* const out = image.rgba.data() + 4 * i;
    const std::size_t first = i * channels;
    for (std::size_t c = 0; c < 3; ++c) out[c] = value_at(texels, first + (grey ? 0 : c));
    out[3] = alpha ? value_at(texels, first + channels - 1) : std::uint8_t{255};
  }
  return image;
}

Rgba8Image decode_plain(ImageFormat format, const std::vector<std::uint8_t>& plain,
                        const std::string& label) {
  const ImageCodec& codec = image_codec();
  try {
    return to_rgba(codec.decode(format, plain));
  } catch (const std::runtime_error& e) {
    throw SceneError(label + ": is corrupt: " + e.what());
  }
}

/// The format by the magic bytes.
ImageFormat encoded_format(std::span<const std::uint8_t> encoded, const std::string& label) {
  constexpr std::array<std::uint8_t, 8> png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  constexpr std::array<std::uint8_t, 3> jpeg{0xFF, 0xD8, 0xFF};
  const auto starts_with = [&encoded](const auto& magic) {
    return encoded.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), encoded.begin());
  };
  if (starts_with(png)) return ImageFormat::png;
  if (starts_with(jpeg)) return ImageFormat::jpeg;
  if (is_webp(encoded)) return ImageFormat::webp;
  constexpr std::array<std::uint8_t, 4> little{'I', 'I', 42, 0}, big{'M', 'M', 0, 42};
  if (starts_with(little) || starts_with(big)) return ImageFormat::tiff;
  throw SceneError(label + ": neither a PNG nor a JPEG, WebP or TIFF");
}

/// The library multiplies a WebP's colours by its alpha, which rounds them: they are read from the
/// image without alpha, and the alpha from the whole.
Rgba8Image decode_webp(std::span<const std::uint8_t> encoded, const std::string& label) {
  const auto whole = plain_webp(encoded, label, true), colors = plain_webp(encoded, label, false);
  Rgba8Image image = decode_plain(ImageFormat::webp, colors, label);
  if (whole == colors) return image;
  const Rgba8Image with_alpha = decode_plain(ImageFormat::webp, whole, label);
  if (with_alpha.rgba.size() != image.rgba.size()) {
    throw SceneError(label + ": is corrupt: its alpha has another size");
  }
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = with_alpha.rgba[i];
  return image;
}

}  // namespace

std::uint64_t texels_of_texture(std::span<const std::uint8_t> encoded, const std::string& label) {
  switch (encoded_format(encoded, label)) {
    case ImageFormat::jpeg:
      return jpeg_texels(encoded, label);
    case ImageFormat::webp:
      return webp_texels(encoded, label);
    case ImageFormat::tiff:
      return tiff_texels(encoded, label);
    default:
      return png_texels(encoded, label);
  }
}

Rgba8Image decode_texture(std::span<const std::uint8_t> encoded, const std::string& label) {
  const ImageFormat format = encoded_format(encoded, label);
  switch (format) {
    case ImageFormat::jpeg:
      return decode_plain(format, plain_jpeg(encoded, label), label);
    case ImageFormat::webp:
      return decode_webp(encoded, label);
    case ImageFormat::tiff:
      return decode_plain(format, plain_tiff_texture(encoded, label), label);
    default:
      return decode_plain(format, plain_png(encoded, label), label);
  }
}

}  // namespace lacuna
