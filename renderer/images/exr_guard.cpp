#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <istream>
#include <optional>
#include <span>
#include <streambuf>
#include <string>
#include <string_view>

#include "renderer/core/scene_error.h"
#include "renderer/images/guards.h"

namespace lacuna {
namespace {

// OpenEXR File Layout: magic, version, then for each part attributes up to an empty name; an empty
// header ends a file of several parts.
constexpr std::uint32_t deep_flag = 0x800, several_parts = 0x1000;
constexpr std::size_t longest_name = 255;
constexpr std::uint32_t deep = 0x70656564;  // first bytes of "deepscanline" and "deeptile"
constexpr std::uintmax_t offset_bytes = 8;  // per tile, in the table after the headers
constexpr std::uint32_t pixel_types = 3;    // unsigned int, half, float

// OpenEXR ignores the stored size of these attributes: with another size it would continue at a
// different position from this guard.
struct FixedSize {
  std::string_view type;
  std::uint32_t bytes;
};
constexpr std::array<FixedSize, 23> fixed_sizes{{
    {"box2i", 16},      {"box2f", 16},   {"chromaticities", 32},
    {"compression", 1}, {"double", 8},   {"envmap", 1},
    {"float", 4},       {"int", 4},      {"keycode", 28},
    {"lineOrder", 1},   {"m33f", 36},    {"m33d", 72},
    {"m44f", 64},       {"m44d", 128},   {"rational", 8},
    {"tiledesc", 9},    {"timecode", 8}, {"v2i", 8},
    {"v2f", 8},         {"v2d", 16},     {"v3i", 12},
    {"v3f", 12},        {"v3d", 24},
}};

/// A stream over bytes in memory, without a copy.
class MemoryBuffer : public std::streambuf {
 public:
  explicit MemoryBuffer(std::span<const std::uint8_t> bytes) {
    char* const begin = reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes.data()));
    setg(begin, begin, begin + bytes.size());  // only read from
  }

 private:
  pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode) override {
    const off_type base = from == std::ios::beg   ? 0
                          : from == std::ios::cur ? gptr() - eback()
                                                  : egptr() - eback();
    return seekpos(base + offset, std::ios::in);
  }
  pos_type seekpos(pos_type position, std::ios::openmode) override {
    const off_type at = position;
    if (at < 0 || at > egptr() - eback()) return off_type{-1};
    setg(eback(), eback() + at, egptr());
    return position;
  }
};

class ExrHeader {
 public:
  ExrHeader(std::span<const std::uint8_t> bytes, const std::string& label)
      : label_(label), size_(bytes.size()), buffer_(bytes), stream_(&buffer_) {}

  void check() {
    integer();  // the magic
    const std::uint32_t flags = integer();
    if ((flags & deep_flag) != 0) refuse_deep();
    const bool parts = (flags & several_parts) != 0;
    for (bool first = true; check_attributes(first) && parts; first = false) {
    }
  }

 private:
  /// Reads the attributes up to the empty name that ends a header. Returns false if there are none.
  bool check_attributes(bool first) {
    bool any = false;
    picture_ = tile_ = {};
    chromaticities_.reset();
    first_colour_.clear();
    for (std::string name = text(); !name.empty(); name = text()) {
      any = true;
      const std::string type = text();
      const std::uint32_t bytes = integer();
      const auto at = static_cast<std::uintmax_t>(stream_.tellg());
      if (bytes > size_ - at) {
        fail("attribute \"" + printable(name) + "\" (" + printable(type) + ") has " +
             std::to_string(bytes) + " bytes; the file ends after " + std::to_string(size_ - at));
      }
      note(name, bytes);
      stream_.seekg(static_cast<std::streamoff>(at));
      const bool sized = check_value(type, at + bytes);
      if (!sized) {
        fail("attribute \"" + printable(name) + "\" has " + std::to_string(bytes) +
             " bytes, not a size of its type " + printable(type));
      }
      stream_.seekg(static_cast<std::streamoff>(at + bytes));
    }
    if (first && !any) fail("there are no attributes");
    check_tiles();
    check_primaries();
    return any;
  }

  /// Stores the attributes that describe the pixels.
  void note(const std::string& name, std::uint32_t bytes) {
    if (name == "dataWindow" && bytes == 16) picture_ = read_window();
    if (name == "tiles" && bytes == 9) tile_ = {integer(), integer()};
    if (name == "chromaticities" && bytes == 32) {
      for (double& v : chromaticities_.emplace()) v = double{std::bit_cast<float>(integer())};
    }
    if (name == "type" && bytes >= sizeof deep && integer() == deep) refuse_deep();
  }

  struct Size {
    std::uint64_t width = 0, height = 0;
  };

  Size read_window() {
    const auto left = static_cast<std::int32_t>(integer()),
               top = static_cast<std::int32_t>(integer());
    const auto right = static_cast<std::int32_t>(integer()),
               bottom = static_cast<std::int32_t>(integer());
    const std::int64_t width = std::int64_t{right} - left + 1,
                       height = std::int64_t{bottom} - top + 1;
    if (width < 1 || height < 1 || width > max_picture_side || height > max_picture_side) {
      refuse("is " + std::to_string(width) + " x " + std::to_string(height) +
             " pixels; allowed: up to " + std::to_string(max_picture_side) + " a side");
    }
    return {static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height)};
  }

  /// The library allocates an offset for every tile; the file must contain them, too.
  void check_tiles() const {
    if (tile_.width == 0 || tile_.height == 0) return;
    const std::uint64_t tiles = (picture_.width + tile_.width - 1) / tile_.width *
                                ((picture_.height + tile_.height - 1) / tile_.height);
    if (tiles > size_ / offset_bytes) {
      refuse("is corrupt: it states " + std::to_string(tiles) + " tiles, in " +
             std::to_string(size_) + " bytes");
    }
  }

  void check_primaries() const {
    if (first_colour_.empty() || !chromaticities_ || are_close(*chromaticities_, rec709)) {
      return;
    }
    refuse("has channel \"" + first_colour_ + "\" of the primaries and white " +
           chromaticities_text(*chromaticities_) + "; allowed: those of Rec. 709, " +
           chromaticities_text(rec709));
  }

  /// Whether a value from here to `end` can be of `type`.
  bool check_value(const std::string& type, std::uintmax_t end) {
    const auto at = [&] { return static_cast<std::uintmax_t>(stream_.tellg()); };
    if (type == "chlist") {
      check_channels();
      return at() == end;
    }
    if (type == "preview") {
      if (end - at() < 8) return false;
      const std::uint64_t width = integer();
      const std::uint64_t height = integer();
      return width < 65536 && height < 65536 && end - at() == 4 * width * height;
    }
    if (type == "stringvector") {
      while (end - at() >= 4) {
        const std::uint32_t length = integer();
        if (length > end - at()) return false;
        stream_.seekg(length, std::ios::cur);
      }
      return at() == end;
    }
    const auto* const fixed = std::find_if(fixed_sizes.begin(), fixed_sizes.end(),
                                           [&](const FixedSize& f) { return f.type == type; });
    return fixed == fixed_sizes.end() || end - at() == fixed->bytes;
  }

  void check_channels() {
    for (std::string name = text(); !name.empty(); name = text()) {
      const std::uint32_t type = integer();
      if (type >= pixel_types) {
        fail("channel \"" + printable(name) + "\" has pixel type " + std::to_string(type) +
             "; allowed: 0 to " + std::to_string(pixel_types - 1));
      }
      integer();  // the flag pLinear
      if (name == "R" || name.ends_with(".R")) first_colour_ = printable(name);
      if (integer() != 1 || integer() != 1) {
        refuse("has channel \"" + printable(name) +
               "\" at less than full resolution, as luminance and chroma have; allowed: RGB, XYZ "
               "or grey at full resolution");
      }
    }
  }

  std::uint32_t integer() {
    std::uint32_t value = 0;  // x86-64 is little-endian, as is OpenEXR
    if (!stream_.read(reinterpret_cast<char*>(&value), sizeof value)) fail("the file ends in it");
    return value;
  }

  std::string text() {
    std::string value;
    for (int c = stream_.get(); c != 0; c = stream_.get()) {
      if (!stream_) fail("the file ends in it");
      if (value.size() == longest_name) {
        fail("a name is longer than " + std::to_string(longest_name) + " bytes");
      }
      value.push_back(static_cast<char>(c));
    }
    return value;
  }

  static std::string printable(std::string s) {
    for (char& c : s) c = c >= 0x20 && c < 0x7f ? c : '?';
    return s;
  }

  [[noreturn]] void fail(const std::string& what) const { refuse("OpenEXR header: " + what); }
  [[noreturn]] void refuse_deep() const { refuse("is a deep image; allowed: flat images"); }
  [[noreturn]] void refuse(const std::string& what) const {
    throw SceneError(label_ + ": " + what);
  }

  const std::string& label_;
  std::uintmax_t size_;
  // Of the part to read.
  Size picture_, tile_;
  std::optional<Chromaticities> chromaticities_;
  std::string first_colour_;  ///< the name of a red channel
  MemoryBuffer buffer_;
  std::istream stream_;
};

}  // namespace

void check_exr_header(std::span<const std::uint8_t> exr, const std::string& label) {
  ExrHeader(exr, label).check();
}

}  // namespace lacuna
