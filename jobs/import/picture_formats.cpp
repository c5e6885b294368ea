#include "jobs/import/picture_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>

#include "renderer/core/scene_error.h"
#include "renderer/images/guards.h"

namespace lacuna {
namespace {

/// Takes bytes one after another.
class ByteCursor {
 public:
  ByteCursor(std::span<const std::uint8_t> bytes, const std::string& label)
      : rest_(bytes), label_(label) {}

  [[noreturn]] void fail(const std::string& message) const {
    throw SceneError(fmt::format("{}: {}", label_, message));
  }
  std::span<const std::uint8_t> take(std::size_t n) {
    if (n > rest_.size()) fail("the file ends early");
    const auto out = rest_.first(n);
    rest_ = rest_.subspan(n);
    return out;
  }
  int byte() { return take(1)[0]; }
  int word() {
    const auto b = take(2);
    return b[0] + 256 * b[1];
  }
  std::size_t left() const { return rest_.size(); }

 private:
  std::span<const std::uint8_t> rest_;
  const std::string& label_;
};

/// The pixels of a TGA in the order of the file, `bytes` each.
std::vector<std::uint8_t> tga_pixels(ByteCursor& file, std::size_t count, std::size_t bytes,
                                     bool packed) {
  if (!packed) {
    const auto all = file.take(count * bytes);
    return {all.begin(), all.end()};
  }
  // A packet has up to 128 pixels.
  if (file.left() < (count + 127) / 128 * (1 + bytes)) file.fail("the file ends early");
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
  ByteCursor file(bytes, label);
  const int id_length = file.byte(), has_palette = file.byte(), kind = file.byte();
  file.take(5);  // of the palette
  file.take(4);  // origin
  CodePicture out;
  out.width = file.word();
  out.height = file.word();
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
  const auto pixels = tga_pixels(file, width * height, size, packed);
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

FloatImage read_pfm(std::span<const std::uint8_t> bytes, const std::string& label) {
  ByteCursor file(bytes, label);
  const auto word = [&] {
    std::string text;
    for (char c = static_cast<char>(file.byte()); c != ' ' && c != '\n' && c != '\t' && c != '\r';
         c = static_cast<char>(file.byte())) {
      text += c;
      if (text.size() > 32) file.fail("no PFM");
    }
    return text;
  };
  const auto number = [&] {
    const std::string text = word();
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
      file.fail(fmt::format("\"{}\" in the header of a PFM; allowed: a number", text));
    }
    return value;
  };
  const std::string magic = word();
  if (magic != "PF" && magic != "Pf") file.fail("no PFM");
  FloatImage out;
  const double width = number(), height = number(), scale = number();
  const auto is_side = [](double n) {
    return n >= 1 && n <= max_picture_side && n == std::floor(n);
  };
  if (!is_side(width) || !is_side(height) || scale == 0) {
    file.fail(fmt::format("{} x {} pixels, scale {}; allowed: 1 to {} a side, a scale other than 0",
                          width, height, scale, max_picture_side));
  }
  out.width = static_cast<int>(width);
  out.height = static_cast<int>(height);
  const std::size_t channels = magic == "PF" ? 3 : 1, columns = static_cast<std::size_t>(out.width);
  const auto data = file.take(columns * static_cast<std::size_t>(out.height) * channels * 4);
  out.rgb.reserve(data.size() / channels / 4 * 3);
  for (int y = out.height - 1; y >= 0; --y) {  // the file begins with the bottom row
    for (std::size_t x = 0; x < columns; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at =
            (static_cast<std::size_t>(y) * columns + x) * channels + (channels == 3 ? c : 0);
        std::array<std::uint8_t, 4> b;
        std::copy_n(&data[4 * at], 4, b.begin());
        if (scale > 0) std::reverse(b.begin(), b.end());  // big-endian
        out.rgb.push_back(std::bit_cast<float>(b) * static_cast<float>(std::abs(scale)));
      }
    }
  }
  return out;
}

}  // namespace lacuna
