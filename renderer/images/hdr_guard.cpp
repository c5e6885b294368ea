#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "renderer/images/checked_bytes.h"
#include "renderer/images/guards.h"

namespace lacuna {
namespace {

constexpr std::size_t pixel_bytes = 4;  // three mantissas and their exponent
constexpr std::size_t shortest_by_channel = 8, longest_by_channel = 0x7fff;

/// Radiance's primaries (`src/common/color.h`), commonly read as Rec. 709.
constexpr Chromaticities radiance_primaries{.640, .330, .290, .600, .150, .060, 1. / 3, 1. / 3};

class HdrGuard {
 public:
  HdrGuard(std::span<const std::uint8_t> hdr, const std::string& label) : in_(hdr, label) {}

  PlainHdr run() {
    read_header();
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " +
                               std::to_string(height_) + " +X " + std::to_string(width_) + "\n";
    plain_.assign(header.begin(), header.end());
    for (int y = 0; y < height_; ++y) read_row(static_cast<std::size_t>(width_));
    return {std::move(plain_), multiplied_};
  }

 private:
  std::string line() {
    constexpr std::size_t longest = 4096;
    std::string text;
    for (char c; (c = static_cast<char>(in_.byte())) != '\n'; text += c) {
      if (text.size() == longest) in_.fail("is corrupt: its header has a line without end");
    }
    if (text.ends_with('\r')) text.pop_back();
    return text;
  }

  /// The numbers after NAME=, if the line begins with it.
  template <std::size_t N>
  std::optional<std::array<double, N>> numbers(const std::string& text, const std::string& name,
                                               const std::string& allowed) const {
    if (!text.starts_with(name + "=")) return std::nullopt;
    std::array<double, N> values{};
    std::istringstream in(text.substr(name.size() + 1));
    for (double& v : values) {
      if (!(in >> v)) refuse(text, allowed);
    }
    std::string rest;
    if (in >> rest) refuse(text, allowed);
    return values;
  }

  [[noreturn]] void refuse(const std::string& text, const std::string& allowed) const {
    in_.fail("has \"" + text.substr(0, 80) + "\" in its header; allowed: " + allowed);
  }

  /// "EXPOSURE, COLORCORR: multipliers that have been applied to all pixels", cumulative; a pixel's
  /// radiance is its value over their product (Radiance file formats, "Picture files").
  void read_line(const std::string& text) {
    if (text.starts_with("FORMAT=")) {
      std::string format;
      std::istringstream(text.substr(7)) >> format;
      if (format != "32-bit_rle_rgbe") refuse(text, "FORMAT=32-bit_rle_rgbe");
    } else if (const auto exposure = numbers<1>(text, "EXPOSURE", "a number above 0")) {
      multiply(text, {exposure->front(), exposure->front(), exposure->front()});
    } else if (const auto colour = numbers<3>(text, "COLORCORR", "three numbers above 0")) {
      multiply(text, *colour);
    } else if (const auto gamma = numbers<1>(text, "GAMMA", "1: linear values")) {
      if (gamma->front() != 1) refuse(text, "1: linear values");
    } else if (const auto xy = numbers<8>(text, "PRIMARIES", "eight coordinates")) {
      const bool unset = *xy == Chromaticities{};
      if (!unset && !are_close(*xy, rec709) && !are_close(*xy, radiance_primaries)) {
        refuse(text,
               chromaticities_text(radiance_primaries) + ", or " + chromaticities_text(rec709));
      }
    }
  }

  void multiply(const std::string& text, const std::array<double, 3>& factors) {
    for (std::size_t k = 0; k < 3; ++k) {
      multiplied_[k] *= factors[k];
      if (!(factors[k] > 0) || !std::isnormal(multiplied_[k])) {
        refuse(text, "numbers above 0, with a product within double precision");
      }
    }
  }

  void read_header() {
    line();  // #?RADIANCE or another name
    for (std::string text = line(); !text.empty(); text = line()) read_line(text);
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

  /// One channel of a row: runs of equal bytes and literal bytes.
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

  /// Flat pixels, with the old run-length encoding: (1, 1, 1, n) repeats the previous pixel n
  /// times, a second one in succession 256 n times.
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
  std::array<double, 3> multiplied_{1, 1, 1};
};

}  // namespace

bool are_close(const Chromaticities& a, const Chromaticities& b) {
  constexpr double written = .002;
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](double x, double y) { return std::abs(x - y) <= written; });
}

std::string chromaticities_text(const Chromaticities& xy) {
  return fmt::format("{:.4g}", fmt::join(xy, " "));
}

PlainHdr plain_hdr(std::span<const std::uint8_t> hdr, const std::string& label) {
  return HdrGuard(hdr, label).run();
}

}  // namespace lacuna
