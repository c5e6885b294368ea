#include <cstdio>

#include "renderer/images/checked_bytes.h"
#include "renderer/images/guards.h"

namespace lacuna {
namespace {

constexpr std::size_t pixel_bytes = 4;  // three mantissas and their exponent
constexpr std::size_t shortest_by_channel = 8, longest_by_channel = 0x7fff;

class HdrGuard {
 public:
  HdrGuard(std::span<const std::uint8_t> hdr, const std::string& label) : in_(hdr, label) {}

  std::vector<std::uint8_t> run() {
    read_header();
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " +
                               std::to_string(height_) + " +X " + std::to_string(width_) + "\n";
    plain_.assign(header.begin(), header.end());
    for (int y = 0; y < height_; ++y) read_row(static_cast<std::size_t>(width_));
    return std::move(plain_);
  }

 private:
  std::string line() {
    constexpr std::size_t longest = 4096;
    std::string text;
    for (char c; (c = static_cast<char>(in_.byte())) != '\n'; text += c) {
      if (text.size() == longest) in_.fail("is corrupt: its header has a line without end");
    }
    return text;
  }

  void read_header() {
    line();  // #?RADIANCE or another name
    bool known = false;
    for (std::string text = line(); !text.empty(); text = line()) {
      if (text.starts_with("FORMAT=")) known = text == "FORMAT=32-bit_rle_rgbe";
    }
    if (!known) in_.fail("has another FORMAT than 32-bit_rle_rgbe");
    const std::string size = line();
    int end = 0;
    if (std::sscanf(size.c_str(), "-Y %7d +X %7d%n", &height_, &width_, &end) != 2 ||
        size.size() != static_cast<std::size_t>(end)) {
      in_.fail("has size \"" + size.substr(0, 40) + "\"; allowed: \"-Y HEIGHT +X WIDTH\"");
    }
    in_.require_size(width_, height_, max_picture_side, "pixels");
  }

  void copy_since(std::size_t begin) {
    const auto bytes = in_.since(begin);
    plain_.insert(plain_.end(), bytes.begin(), bytes.end());
  }

  void read_row(std::size_t width) {
    const std::size_t begin = in_.at();
    const auto first = in_.take(pixel_bytes);
    const bool by_channel = width >= shortest_by_channel && width <= longest_by_channel &&
                            first[0] == 2 && first[1] == 2 && (first[2] & 0x80) == 0;
    if (!by_channel) return read_flat(width, first);
    if ((std::size_t{first[2]} << 8 | first[3]) != width) {
      in_.fail("is corrupt: a row has another length");
    }
    for (int channel = 0; channel < 4; ++channel) skip_runs(width);
    copy_since(begin);
  }

  /// One channel of a row: runs of one byte and of different ones.
  void skip_runs(std::size_t width) {
    while (width > 0) {
      const std::uint8_t code = in_.byte();
      const bool same = code > 128;
      const std::size_t length = same ? code - 128U : code;
      if (length == 0 || length > width) in_.fail("is corrupt: a run goes beyond its row");
      in_.take(same ? 1 : length);
      width -= length;
    }
  }

  /// Pixel after pixel. The old form: (1, 1, 1, n) repeats the one before n times, and another such
  /// at once after it 256 n times.
  void read_flat(std::size_t width, std::span<const std::uint8_t> pixel) {
    std::span<const std::uint8_t> last;
    unsigned shift = 0;
    for (std::size_t left = width;; pixel = in_.take(pixel_bytes)) {
      const bool repeats = pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1;
      const std::size_t length = !repeats     ? 1
                                 : shift < 32 ? std::size_t{pixel[3]} << shift
                                              : left + 1;
      if (length > left || (repeats && last.empty())) {
        in_.fail("is corrupt: a run goes beyond its row");
      }
      if (!repeats) last = pixel;
      for (std::size_t i = 0; i < length; ++i) {
        plain_.insert(plain_.end(), last.begin(), last.end());
      }
      shift = repeats ? shift + 8 : 0;
      left -= length;
      if (left == 0) return;
    }
  }

  CheckedBytes in_;
  std::vector<std::uint8_t> plain_;
  int width_ = 0, height_ = 0;
};

}  // namespace

std::vector<std::uint8_t> plain_hdr(std::span<const std::uint8_t> hdr, const std::string& label) {
  return HdrGuard(hdr, label).run();
}

}  // namespace lacuna
