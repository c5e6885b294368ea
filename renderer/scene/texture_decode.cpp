#include "renderer/scene/texture_decode.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string_view>

#include "renderer/scene/scene_data.h"

namespace lacuna {
namespace {

constexpr int max_side = 16384;

/// OpenImageIO's name of the format; its own guessing would try every plugin on hostile bytes.
const char* format_of(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint8_t, 8> png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  constexpr std::array<std::uint8_t, 3> jpeg{0xFF, 0xD8, 0xFF};
  const auto starts_with = [&bytes](const auto& magic) {
    return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
  };
  return starts_with(png) ? "png" : starts_with(jpeg) ? "jpeg" : nullptr;
}

/// Whether a PNG's chunks are all there, to its IEND. A short read in the middle of one makes
/// libpng jump out of OpenImageIO, which then loses memory.
bool has_whole_chunks(std::span<const std::uint8_t> png) {
  constexpr std::size_t signature = 8, around = 12;  // length and type before the data, CRC behind
  for (auto rest = png.subspan(signature); rest.size() >= around;) {
    const std::size_t length = std::size_t{rest[0]} << 24 | std::size_t{rest[1]} << 16 |
                               std::size_t{rest[2]} << 8 | rest[3];
    if (length > rest.size() - around) return false;
    if (std::memcmp(&rest[4], "IEND", 4) == 0) return true;
    rest = rest.subspan(around + length);
  }
  return false;
}

void expand(const std::uint8_t* from, std::size_t channels, std::vector<std::uint8_t>& rgba) {
  const bool grey = channels < 3;
  const bool alpha = channels == 2 || channels == 4;
  for (std::size_t i = 0; i < rgba.size() / 4; ++i) {
    const std::uint8_t* in = from + i * channels;
    std::uint8_t* out = rgba.data() + i * 4;
    out[0] = in[0];
    out[1] = grey ? in[0] : in[1];
    out[2] = grey ? in[0] : in[2];
    out[3] = alpha ? in[channels - 1] : 255;
  }
}

}  // namespace

Rgba8Image decode_png_or_jpeg(std::span<const std::uint8_t> encoded, const std::string& label) {
  const auto fail = [&label](const std::string& what) { throw SceneError(label + ": " + what); };
  const char* format = format_of(encoded);
  if (format == nullptr) fail("neither a PNG nor a JPEG");
  if (format == std::string_view("png") && !has_whole_chunks(encoded)) {
    fail("is corrupt: it ends before its last chunk (IEND)");
  }
  const auto in = OIIO::ImageInput::create(format);
  if (!in) fail(std::string("OpenImageIO has no reader for ") + format);

  OIIO::Filesystem::IOMemReader memory(encoded.data(), encoded.size());
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  OIIO::ImageSpec spec;
  in->set_ioproxy(&memory);
  if (!in->open(std::string("memory.") + format, spec, hints)) {
    fail("cannot be decoded: " + in->geterror());
  }
  if (spec.width < 1 || spec.height < 1 || spec.width > max_side || spec.height > max_side) {
    fail("is " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
         " texels; allowed: up to " + std::to_string(max_side) + " a side");
  }
  if (spec.nchannels < 1 || spec.nchannels > 4) {
    fail("has " + std::to_string(spec.nchannels) + " channels; allowed: 1 to 4");
  }
  Rgba8Image image{spec.width, spec.height, {}};
  const auto texels = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  // Not set to zero: memory is used up only as texels come, however large the header says they are.
  const auto stored = std::make_unique_for_overwrite<std::uint8_t[]>(texels * channels);
  const bool read = in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, stored.get());
  // libjpeg fills what a truncated file lacks with grey and only warns: a warning is an error here.
  if (!read || in->has_error()) fail("is corrupt: " + in->geterror());
  if (channels == 4) {
    image.rgba.assign(stored.get(), stored.get() + texels * channels);
  } else {
    image.rgba.resize(texels * 4);
    expand(stored.get(), channels, image.rgba);
  }
  return image;
}

}  // namespace lacuna
