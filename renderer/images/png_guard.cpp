#include <algorithm>
#include <string_view>

#include "renderer/images/checked_bytes.h"
#include "renderer/images/guards.h"

namespace lacuna {
namespace {

constexpr std::size_t png_signature_bytes = 8;
constexpr std::uint32_t png_header_bytes = 13;
/// The largest expansion of Deflate, bytes per byte.
constexpr std::uint64_t largest_expansion = 1032;

/// Values per texel, by colour type: grey, -, RGB, palette, grey and alpha, -, RGBA.
constexpr std::uint64_t channels_of[] = {1, 0, 3, 1, 2, 0, 4};

struct PngHeader {
  std::uint64_t width = 0, height = 0, depth = 0, colour_type = 0;
  /// Bytes of all texels, uncompressed.
  std::uint64_t bytes() const { return width * height * depth * channels_of[colour_type] / 8; }
};

PngHeader read_png_header(CheckedBytes chunk) {
  PngHeader h{chunk.big_endian(4), chunk.big_endian(4), chunk.byte(), chunk.byte()};
  chunk.require_size(static_cast<std::int64_t>(h.width), static_cast<std::int64_t>(h.height),
                     max_texture_side, "texels");
  if (h.colour_type >= std::size(channels_of) || channels_of[h.colour_type] == 0) {
    chunk.fail("has colour type " + std::to_string(h.colour_type) + "; allowed: 0, 2, 3, 4, 6");
  }
  if (h.depth != 1 && h.depth != 2 && h.depth != 4 && h.depth != 8 && h.depth != 16) {
    chunk.fail("has " + std::to_string(h.depth) + " bits a channel; allowed: 1, 2, 4, 8, 16");
  }
  return h;
}

}  // namespace

std::uint64_t png_texels(std::span<const std::uint8_t> png, const std::string& label) {
  CheckedBytes in(png, label);
  in.take(png_signature_bytes + 8);  // and the length and type of the first chunk
  const PngHeader header = read_png_header({in.take(png_header_bytes), label});
  return header.width * header.height;
}

std::vector<std::uint8_t> plain_png(std::span<const std::uint8_t> png, const std::string& label) {
  CheckedBytes in(png, label);
  const auto signature = in.take(png_signature_bytes);
  std::vector<std::uint8_t> plain(signature.begin(), signature.end());
  plain.reserve(png.size());
  PngHeader header;
  std::uint64_t compressed = 0;
  for (std::string_view type; type != "IEND";) {
    const std::size_t begin = in.at();
    const std::uint32_t length = in.big_endian(4);
    type = {reinterpret_cast<const char*>(in.take(4).data()), 4};
    const auto data = in.take(length);
    in.take(4);  // the checksum, which the library verifies
    if ((begin == png_signature_bytes) != (type == "IHDR") ||
        (type == "IHDR" && length != png_header_bytes)) {
      in.fail("is corrupt: it does not begin with its size");
    }
    if (type == "IHDR") header = read_png_header({data, label});
    if (type == "IDAT") compressed += length;
    // Critical chunks begin with a capital; of the others, only transparency affects texels.
    const bool needed = (static_cast<unsigned char>(type[0]) & 0x20) == 0 || type == "tRNS";
    const auto chunk = in.since(begin);
    if (needed) plain.insert(plain.end(), chunk.begin(), chunk.end());
  }
  if (header.bytes() > (compressed + 1) * largest_expansion) {
    in.fail("is corrupt: " + std::to_string(compressed) + " bytes cannot hold its " +
            std::to_string(header.width) + " x " + std::to_string(header.height) + " texels");
  }
  return plain;
}

}  // namespace lacuna
