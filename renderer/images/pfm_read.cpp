#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>

#include "renderer/images/checked_bytes.h"
#include "renderer/images/guards.h"
#include "renderer/images/image_read.h"

namespace lacuna {

FloatImage read_pfm(std::span<const std::uint8_t> bytes, const std::string& label) {
  CheckedBytes file(bytes, label);
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
