#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "tests/temporary_folder.h"

// Image files byte by byte, after the formats' own documents: what the library reads in the tests,
// the library did not write.

namespace lacuna::test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes read_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(stream), {});
}

/// Appends an integer of `bytes` bytes, its least significant first.
inline void put_little(Bytes& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}
inline void put_big(Bytes& out, std::uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}
inline void put_text(Bytes& out, const std::string& text) {
  out.insert(out.end(), text.begin(), text.end());
}

// PNG.

/// CRC-32 of PNG (ISO 3309), bit by bit.
inline std::uint32_t crc32(const Bytes& bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const std::uint8_t b : bytes) {
    crc ^= b;
    for (int i = 0; i < 8; ++i) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320U : 0U);
  }
  return ~crc;
}

inline void put_chunk(Bytes& png, const std::string& type, const Bytes& data) {
  put_big(png, data.size(), 4);
  Bytes content(type.begin(), type.end());
  content.insert(content.end(), data.begin(), data.end());
  png.insert(png.end(), content.begin(), content.end());
  put_big(png, crc32(content), 4);
}

/// A zlib stream that stores: RFC 1950 and 1951.
inline Bytes stored_zlib(const Bytes& data) {
  constexpr std::size_t largest = 65535;
  Bytes out{0x78, 0x01};
  for (std::size_t at = 0; at < data.size() || at == 0; at += largest) {
    const std::size_t n = std::min(largest, data.size() - at);
    out.push_back(at + n == data.size() ? 1 : 0);
    put_little(out, n, 2);
    put_little(out, ~n & 0xffff, 2);
    out.insert(out.end(), data.begin() + static_cast<std::ptrdiff_t>(at),
               data.begin() + static_cast<std::ptrdiff_t>(at + n));
  }
  std::uint32_t a = 1, b = 0;
  for (const std::uint8_t v : data) {
    a = (a + v) % 65521;
    b = (b + a) % 65521;
  }
  put_big(out, b << 16 | a, 4);
  return out;
}

/// What a PNG says of itself, and chunks between its header and its pixels.
struct PngKind {
  int bits = 8;
  int colour_type = 2;  ///< 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA
  bool interlaced = false;
  std::vector<std::pair<std::string, Bytes>> chunks = {};
};

/// `rows`: the bytes of each row as the format packs them; of the seven passes one after the other
/// where it is interlaced.
inline Bytes make_png(int width, int height, const PngKind& kind, const std::vector<Bytes>& rows) {
  Bytes png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  Bytes header;
  put_big(header, static_cast<std::uint64_t>(width), 4);
  put_big(header, static_cast<std::uint64_t>(height), 4);
  for (const int v : {kind.bits, kind.colour_type, 0, 0, kind.interlaced ? 1 : 0}) {
    header.push_back(static_cast<std::uint8_t>(v));
  }
  put_chunk(png, "IHDR", header);
  for (const auto& [type, data] : kind.chunks) put_chunk(png, type, data);
  Bytes filtered;
  for (const Bytes& row : rows) {
    filtered.push_back(0);
    filtered.insert(filtered.end(), row.begin(), row.end());
  }
  put_chunk(png, "IDAT", stored_zlib(filtered));
  put_chunk(png, "IEND", {});
  return png;
}

/// The bytes of a PNG with 8 bits a channel: grey, grey and alpha, RGB or RGBA.
inline Bytes encode8(int width, int height, int channels, const std::vector<std::uint8_t>& pixels) {
  constexpr std::array<int, 4> colour_types{0, 4, 2, 6};
  std::vector<Bytes> rows;
  rows.reserve(static_cast<std::size_t>(height));
  const auto stride = static_cast<std::ptrdiff_t>(width) * channels;
  for (int y = 0; y < height; ++y) {
    rows.emplace_back(pixels.begin() + y * stride, pixels.begin() + (y + 1) * stride);
  }
  const int colour_type = colour_types[static_cast<std::size_t>(channels - 1)];
  return make_png(width, height, {.colour_type = colour_type}, rows);
}

// JPEG.

/// Of the fuzz targets: flat.jpg is 16 x 16 texels of (102, 102, 102), rgb_large.jpg 40 x 24 that
/// differ.
inline Bytes jpeg_seed(const std::string& name) {
  return read_bytes(std::filesystem::path(LACUNA_SOURCE_DIR) / "tests/fuzz/corpus/texture" / name);
}

// OpenEXR.

inline void put_attribute(Bytes& out, const std::string& name, const std::string& type,
                          const Bytes& value) {
  put_text(out, name + '\0' + type + '\0');
  put_little(out, value.size(), 4);
  out.insert(out.end(), value.begin(), value.end());
}

inline Bytes box(int width, int height) {
  Bytes value;
  for (const int v : {0, 0, width - 1, height - 1}) {
    put_little(value, static_cast<std::uint32_t>(v), 4);
  }
  return value;
}

/// What an EXR says beside its channels.
struct ExrKind {
  int display_width = 0, display_height = 0;                ///< 0: as large as the picture
  std::uint32_t flags = 0;                                  ///< of its version field
  std::uint32_t sampling = 1;                               ///< of all channels
  std::vector<std::array<std::string, 3>> attributes = {};  ///< name, type, value
};

/// Writes an EXR of 32-bit channels, not compressed; `pixels` interleaved in their order.
inline std::filesystem::path write_exr_file(const TemporaryFolder& folder, const std::string& name,
                                            const std::vector<std::string>& channels,
                                            const std::vector<float>& pixels, int width, int height,
                                            const ExrKind& kind = {}) {
  std::vector<std::size_t> order(channels.size());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return channels[a] < channels[b]; });
  Bytes list;
  for (const std::size_t c : order) {
    put_text(list, channels[c] + '\0');
    for (const std::uint32_t v : {2U, 0U, kind.sampling, kind.sampling}) put_little(list, v, 4);
  }
  list.push_back(0);
  Bytes file{0x76, 0x2f, 0x31, 0x01};
  put_little(file, 2 | kind.flags, 4);
  put_attribute(file, "channels", "chlist", list);
  put_attribute(file, "compression", "compression", {0});
  put_attribute(file, "dataWindow", "box2i", box(width, height));
  put_attribute(
      file, "displayWindow", "box2i",
      kind.display_width > 0 ? box(kind.display_width, kind.display_height) : box(width, height));
  put_attribute(file, "lineOrder", "lineOrder", {0});
  put_attribute(file, "pixelAspectRatio", "float", {0, 0, 0x80, 0x3f});
  put_attribute(file, "screenWindowCenter", "v2f", Bytes(8, 0));
  put_attribute(file, "screenWindowWidth", "float", {0, 0, 0x80, 0x3f});
  for (const auto& [key, type, value] : kind.attributes) {
    put_attribute(file, key, type, Bytes(value.begin(), value.end()));
  }
  file.push_back(0);
  const std::size_t row = 4 * channels.size() * static_cast<std::size_t>(width);
  const std::size_t first = file.size() + 8 * static_cast<std::size_t>(height);
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    put_little(file, first + y * (row + 8), 8);
  }
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    put_little(file, y, 4);
    put_little(file, row, 4);
    for (const std::size_t c : order) {
      for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
        const std::size_t i = (y * static_cast<std::size_t>(width) + x) * channels.size() + c;
        put_little(file, std::bit_cast<std::uint32_t>(pixels[i]), 4);
      }
    }
  }
  return folder.write(name, file);
}

// TIFF.

/// One entry of a TIFF's directory; all values are LONG.
struct TiffEntry {
  int tag = 0;
  std::vector<std::uint32_t> values;
};

/// A TIFF of 32-bit floats in one strip, little-endian. `more` entries take the place of those of
/// the same tag.
inline Bytes make_tiff(int width, int height, int channels, const std::vector<float>& pixels,
                       const std::vector<TiffEntry>& more = {}) {
  Bytes data;
  for (const float v : pixels) put_little(data, std::bit_cast<std::uint32_t>(v), 4);
  const auto n = static_cast<std::size_t>(channels);
  std::vector<TiffEntry> entries{{256, {static_cast<std::uint32_t>(width)}},
                                 {257, {static_cast<std::uint32_t>(height)}},
                                 {258, std::vector<std::uint32_t>(n, 32)},
                                 {259, {1}},
                                 {262, {channels == 1 ? 1U : 2U}},
                                 {273, {8}},
                                 {277, {static_cast<std::uint32_t>(channels)}},
                                 {278, {static_cast<std::uint32_t>(height)}},
                                 {279, {static_cast<std::uint32_t>(data.size())}},
                                 {339, std::vector<std::uint32_t>(n, 3)}};
  for (const TiffEntry& entry : more) {
    std::erase_if(entries, [&](const TiffEntry& e) { return e.tag == entry.tag; });
    entries.push_back(entry);
  }
  std::sort(entries.begin(), entries.end(),
            [](const TiffEntry& a, const TiffEntry& b) { return a.tag < b.tag; });
  Bytes file{'I', 'I', 42, 0};
  put_little(file, 8 + data.size(), 4);
  file.insert(file.end(), data.begin(), data.end());
  put_little(file, entries.size(), 2);
  Bytes beyond;  // values that do not fit into their entry
  const std::size_t after = file.size() + 12 * entries.size() + 4;
  for (const TiffEntry& e : entries) {
    put_little(file, static_cast<std::uint64_t>(e.tag), 2);
    put_little(file, 4, 2);
    put_little(file, e.values.size(), 4);
    put_little(file, e.values.size() == 1 ? e.values[0] : after + beyond.size(), 4);
    if (e.values.size() == 1) continue;
    for (const std::uint32_t v : e.values) put_little(beyond, v, 4);
  }
  put_little(file, 0, 4);
  file.insert(file.end(), beyond.begin(), beyond.end());
  return file;
}

}  // namespace lacuna::test
