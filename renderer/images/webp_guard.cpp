#include <algorithm>
#include <string_view>

#include "renderer/images/checked_bytes.h"
#include "renderer/images/guards.h"

// The container is described in RFC 9649: chunks of RIFF, with a frame by VP8 (RFC 6386) or VP8L.

namespace lacuna {
namespace {

constexpr std::size_t riff_bytes = 12;  // "RIFF", a size, "WEBP"
constexpr std::size_t chunk_header_bytes = 8;

struct Chunk {
  std::string_view type;
  std::span<const std::uint8_t> data;
  std::span<const std::uint8_t> whole;  ///< with type, size and padding
};

Chunk next_chunk(CheckedBytes& in) {
  const std::size_t begin = in.at();
  const std::string_view type{reinterpret_cast<const char*>(in.take(4).data()), 4};
  const std::uint32_t bytes = in.little_endian(4);
  const auto data = in.take(bytes);
  if (bytes % 2 == 1 && !in.empty()) in.take(1);  // some writers omit the last padding
  return {type, data, in.since(begin)};
}

std::uint64_t texels_of_size(const CheckedBytes& in, std::uint32_t width, std::uint32_t height) {
  in.require_size(width, height, max_texture_side, "texels");
  return std::uint64_t{width} * height;
}

/// The number of texels by the header of a frame; 0: the chunk is no frame.
std::uint64_t frame_texels(const Chunk& chunk, const std::string& label) {
  CheckedBytes in(chunk.data, label);
  if (chunk.type == "VP8 ") {
    constexpr std::uint32_t start_code = 0x2a019d, side = 0x3fff;
    const std::uint32_t tag = in.little_endian(3);
    if ((tag & 1) != 0 || in.little_endian(3) != start_code) {
      in.fail("is corrupt: its frame has no start code");
    }
    const std::uint32_t width = in.little_endian(2) & side, height = in.little_endian(2) & side;
    return texels_of_size(in, width, height);
  }
  if (chunk.type == "VP8L") {
    constexpr std::uint8_t signature = 0x2f;
    constexpr std::uint32_t side = 0x3fff, side_bits = 14;
    if (in.byte() != signature) in.fail("is corrupt: its frame has no signature");
    const std::uint32_t bits = in.little_endian(4);
    return texels_of_size(in, (bits & side) + 1, ((bits >> side_bits) & side) + 1);
  }
  return 0;
}

/// What an extended file says of its canvas.
struct Canvas {
  bool there = false;
  std::uint64_t texels = 0;
};

Canvas canvas_of(const Chunk& chunk, const std::string& label) {
  if (chunk.type != "VP8X") return {};
  CheckedBytes in(chunk.data, label);
  constexpr std::uint32_t animation = 2;
  if ((in.little_endian(4) & animation) != 0) in.fail("is an animation; allowed: one image");
  const std::uint32_t width = in.little_endian(3) + 1, height = in.little_endian(3) + 1;
  return {true, texels_of_size(in, width, height)};
}

void put_little(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

}  // namespace

bool is_webp(std::span<const std::uint8_t> bytes) {
  const std::string_view text{reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  return text.starts_with("RIFF") && text.size() >= riff_bytes && text.substr(8, 4) == "WEBP";
}

std::uint64_t webp_texels(std::span<const std::uint8_t> webp, const std::string& label) {
  CheckedBytes in(webp, label);
  in.take(riff_bytes);
  const Chunk first = next_chunk(in);
  if (const Canvas canvas = canvas_of(first, label); canvas.there) return canvas.texels;
  const std::uint64_t texels = frame_texels(first, label);
  if (texels == 0) in.fail("is corrupt: it does not begin with its size");
  return texels;
}

std::vector<std::uint8_t> plain_webp(std::span<const std::uint8_t> webp, const std::string& label,
                                     bool alpha) {
  CheckedBytes in(webp, label);
  in.take(riff_bytes);
  Canvas canvas;
  std::vector<std::uint8_t> chunks;
  std::uint64_t texels = 0;
  while (!in.empty() && texels == 0) {
    const Chunk chunk = next_chunk(in);
    if (chunk.type == "VP8X") canvas = canvas_of(chunk, label);
    texels = frame_texels(chunk, label);
    const bool of_alpha = chunk.type == "VP8X" || chunk.type == "ALPH";
    if (texels == 0 && !(of_alpha && alpha)) continue;
    const std::size_t begin = chunks.size() + chunk_header_bytes;
    chunks.insert(chunks.end(), chunk.whole.begin(), chunk.whole.end());
    constexpr std::uint8_t has_alpha = 0x10;
    if (chunk.type == "VP8X") chunks[begin] &= has_alpha;  // no profile, no camera data
    if (chunk.type == "VP8L" && !alpha) {
      chunks[begin + 4] = static_cast<std::uint8_t>(chunks[begin + 4] & ~has_alpha);
    }
  }
  if (texels == 0) in.fail("is corrupt: it has no frame");
  if (canvas.there && canvas.texels != texels) {
    in.fail("is corrupt: its frame is not as large as its canvas");
  }
  if (chunks.size() % 2 == 1) chunks.push_back(0);
  std::vector<std::uint8_t> plain{'R', 'I', 'F', 'F'};
  put_little(plain, static_cast<std::uint32_t>(chunks.size() + 4));
  plain.insert(plain.end(), {'W', 'E', 'B', 'P'});
  plain.insert(plain.end(), chunks.begin(), chunks.end());
  return plain;
}

}  // namespace lacuna
