#include "renderer/scene/radiance_hdr.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>

#include "renderer/scene/scene_data.h"

namespace lacuna {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

class Reader {
 public:
  Reader(const std::filesystem::path& file, int max_side)
      : file_(file), in_(file, std::ios::binary), max_side_(max_side) {}

  FloatImage read() {
    FloatImage image;
    read_header(image.width, image.height);
    const auto width = static_cast<std::size_t>(image.width);
    std::vector<Rgbe> row(width);
    for (int y = 0; y < image.height; ++y) {
      read_row(row);
      for (const Rgbe& p : row) {
        const float scale = p[3] == 0 ? 0 : std::ldexp(1.0F, p[3] - (128 + 8));
        for (std::size_t c = 0; c < 3; ++c) image.rgb.push_back(static_cast<float>(p[c]) * scale);
      }
    }
    return image;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw SceneError(file_.string() + ": " + what);
  }
  std::uint8_t byte() {
    const int c = in_.get();
    if (c == std::char_traits<char>::eof()) fail("is corrupt: it ends early");
    return static_cast<std::uint8_t>(c);
  }
  std::string line() {
    constexpr std::size_t longest = 4096;
    std::string text;
    for (char c; (c = static_cast<char>(byte())) != '\n'; text += c) {
      if (text.size() == longest) fail("is corrupt: its header has a line without end");
    }
    return text;
  }

  void read_header(int& width, int& height) {
    line();  // #?RADIANCE or another name
    bool known = false;
    for (std::string text = line(); !text.empty(); text = line()) {
      if (text.starts_with("FORMAT=")) known = text == "FORMAT=32-bit_rle_rgbe";
    }
    if (!known) fail("has another FORMAT than 32-bit_rle_rgbe");
    const std::string size = line();
    int end = 0;
    if (std::sscanf(size.c_str(), "-Y %7d +X %7d%n", &height, &width, &end) != 2 ||
        size.size() != static_cast<std::size_t>(end)) {
      fail("has size \"" + size.substr(0, 40) + "\"; allowed: \"-Y HEIGHT +X WIDTH\"");
    }
    if (width < 1 || height < 1 || width > max_side_ || height > max_side_) {
      fail("is " + std::to_string(width) + " x " + std::to_string(height) +
           " pixels; allowed: up to " + std::to_string(max_side_) + " a side");
    }
  }

  void read_row(std::vector<Rgbe>& row) {
    const Rgbe first{byte(), byte(), byte(), byte()};
    const std::size_t n = row.size();
    const bool by_channel = first[0] == 2 && first[1] == 2 && (first[2] & 0x80) == 0;
    if (n < 8 || n > 0x7fff || !by_channel) return read_flat(row, first);
    if (std::size_t{first[2]} << 8 != (n & 0xff00) || first[3] != (n & 0xff)) {
      fail("is corrupt: a row has another length");
    }
    for (std::size_t channel = 0; channel < 4; ++channel) read_runs(row, channel);
  }

  /// One channel of a row: runs of one byte and of different ones.
  void read_runs(std::vector<Rgbe>& row, std::size_t channel) {
    for (std::size_t x = 0; x < row.size();) {
      const std::uint8_t code = byte();
      const bool same = code > 128;
      const std::size_t length = same ? code - 128U : code;
      if (length == 0 || length > row.size() - x) fail("is corrupt: a run goes beyond its row");
      const std::uint8_t value = same ? byte() : std::uint8_t{0};
      for (const std::size_t end = x + length; x < end; ++x) {
        row[x][channel] = same ? value : byte();
      }
    }
  }

  /// Pixel after pixel; (1, 1, 1, n) repeats the one before n times, and another such at once after
  /// it 256 n times (the old form).
  void read_flat(std::vector<Rgbe>& row, Rgbe pixel) {
    unsigned shift = 0;
    for (std::size_t x = 0;;) {
      if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
        const std::size_t length = shift < 32 ? std::size_t{pixel[3]} << shift : row.size() + 1;
        if (x == 0 || length > row.size() - x) fail("is corrupt: a run goes beyond its row");
        for (std::size_t i = 0; i < length; ++i, ++x) row[x] = row[x - 1];
        shift += 8;
      } else {
        row[x++] = pixel;
        shift = 0;
      }
      if (x == row.size()) return;
      pixel = {byte(), byte(), byte(), byte()};
    }
  }

  const std::filesystem::path& file_;
  std::ifstream in_;
  int max_side_;
};

}  // namespace

FloatImage read_radiance_hdr(const std::filesystem::path& file, int max_side) {
  return Reader(file, max_side).read();
}

}  // namespace lacuna
