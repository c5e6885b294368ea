#include "jobs/import/tga_picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/images/checked_bytes.h"
#include "renderer/images/guards.h"

namespace lacuna {
namespace {

/// The pixels of a TGA in the order of the file, `bytes` each.
std::vector<std::uint8_t> tga_pixels(CheckedBytes& file, std::size_t left, std::size_t count,
                                     std::size_t bytes, bool packed) {
  if (!packed) {
    const auto all = file.take(count * bytes);
    return {all.begin(), all.end()};
  }
  // A packet has up to 128 pixels.
  if (left < (count + 127) / 128 * (1 + bytes)) file.fail("is corrupt: it ends early");
  std::vector<std::uint8_t> out;
  out.reserve(count * bytes);
  while (out.size() < count * bytes) {
    const int head = file.byte();
    const std::size_t n = std::min<std::size_t>(head % 128 + 1, count - out.size() / bytes);
    const bool run = head >= 128;
    const auto values = file.take(run ? bytes : n * bytes);
    for (std::size_t i = 0; i < (run ? n : 1); ++i) {
      out.insert(out.end(), values.begin(), values.end());
    }
  }
  return out;
}

}  // namespace

CodePicture read_tga(std::span<const std::uint8_t> bytes, const std::string& label) {
  CheckedBytes file(bytes, label);
  const int id_length = file.byte(), has_palette = file.byte(), kind = file.byte();
  file.take(5);  // of the palette
  file.take(4);  // origin
  CodePicture out;
  out.width = static_cast<int>(file.little_endian(2));
  out.height = static_cast<int>(file.little_endian(2));
  const int depth = file.byte(), flags = file.byte();
  const bool grey = kind == 3 || kind == 11, packed = kind == 10 || kind == 11;
  const bool known = has_palette == 0 && (grey ? depth == 8 : depth == 24 || depth == 32) &&
                     (grey || kind == 2 || kind == 10);
  if (!known) {
    file.fail(
        fmt::format("TGA of kind {} with {} bits; allowed: grey of 8 bits, colours of 24 or 32 "
                    "bits without a palette",
                    kind, depth));
  }
  const bool sane = out.width > 0 && out.height > 0 && out.width <= max_texture_side &&
                    out.height <= max_texture_side;
  if (!sane) {
    file.fail(fmt::format("{} x {} pixels; allowed: 1 to {} a side", out.width, out.height,
                          max_texture_side));
  }
  file.take(static_cast<std::size_t>(id_length));
  out.channels = depth == 32 ? 4 : 3;
  const auto size = static_cast<std::size_t>(depth / 8);
  const auto width = static_cast<std::size_t>(out.width),
             height = static_cast<std::size_t>(out.height);
  const auto pixels = tga_pixels(file, bytes.size() - file.at(), width * height, size, packed);
  const bool from_top = (flags & 0x20) != 0, from_right = (flags & 0x10) != 0;
  out.codes.reserve(width * height * static_cast<std::size_t>(out.channels));
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t row = from_top ? y : height - 1 - y,
                        column = from_right ? width - 1 - x : x;
      const std::uint8_t* p = &pixels[(row * width + column) * size];
      // Stored as blue, green, red, alpha.
      for (const std::size_t c : {2, 1, 0}) out.codes.push_back(p[grey ? 0 : c]);
      if (out.channels == 4) out.codes.push_back(p[3]);
    }
  }
  return out;
}

}  // namespace lacuna
