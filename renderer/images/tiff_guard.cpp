#include <algorithm>
#include <array>
#include <map>

#include "renderer/images/checked_bytes.h"
#include "renderer/images/guards.h"

namespace lacuna {
namespace {

// Tags (TIFF 6.0): only those that define a picture.
enum TiffTag : std::uint16_t {
  image_width = 256,
  image_length = 257,
  bits_per_sample = 258,
  compression = 259,
  photometric = 262,
  strip_offsets = 273,
  orientation = 274,
  samples_per_pixel = 277,
  rows_per_strip = 278,
  strip_bytes = 279,
  planar_configuration = 284,
  predictor = 317,
  tile_width = 322,
  tile_length = 323,
  tile_offsets = 324,
  tile_bytes = 325,
  extra_samples = 338,
  sample_format = 339
};
constexpr std::array<std::uint16_t, 18> needed_tags{
    image_width,          image_length,  bits_per_sample,   compression,    photometric,
    strip_offsets,        orientation,   samples_per_pixel, rows_per_strip, strip_bytes,
    planar_configuration, predictor,     tile_width,        tile_length,    tile_offsets,
    tile_bytes,           extra_samples, sample_format};

constexpr std::size_t entry_bytes = 12;
constexpr std::uint32_t type_short = 3, type_long = 4;
constexpr std::uint32_t format_float = 3;
/// None, LZW, Deflate by two numbers, PackBits.
constexpr std::array<std::uint32_t, 5> compressions{1, 5, 8, 32946, 32773};
/// An upper bound of the expansion of all of these, bytes per byte.
constexpr std::uint64_t largest_tiff_expansion = 4096;

class TiffGuard {
 public:
  enum class Kind { picture, texture };

  TiffGuard(std::span<const std::uint8_t> tiff, const std::string& label, Kind kind)
      : plain_(tiff.begin(), tiff.end()), in_(plain_, label), kind_(kind) {
    if (plain_.size() < 8) in_.fail("is corrupt: it ends early");
    little_ = plain_[0] == 'I';
  }

  std::vector<std::uint8_t> run() {
    read_directory();
    check_pixels();
    check_data();
    return std::move(plain_);
  }
  std::uint64_t pixels() {
    read_directory();
    check_size();
    return std::uint64_t{width_} * height_;
  }

 private:
  using Values = std::vector<std::uint32_t>;

  std::uint32_t number(std::size_t at, std::size_t bytes) const {
    if (at > plain_.size() || bytes > plain_.size() - at) in_.fail("is corrupt: it ends early");
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
      value = value << 8 | plain_[at + (little_ ? bytes - 1 - i : i)];
    }
    return value;
  }
  void put(std::size_t at, std::uint32_t value, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) {
      plain_[at + (little_ ? i : bytes - 1 - i)] = static_cast<std::uint8_t>(value >> (8 * i));
    }
  }

  /// Reads the first directory, reduced to the needed tags and without a link to the next one.
  void read_directory() {
    const std::size_t begin = number(4, 4);
    const std::uint32_t entries = number(begin, 2);
    number(begin + 2, 1);
    const std::size_t end = begin + 2 + entries * entry_bytes;
    number(end, 4);
    std::size_t to = begin + 2;
    for (std::size_t at = begin + 2; at < end; at += entry_bytes) {
      const auto tag = static_cast<std::uint16_t>(number(at, 2));
      if (std::find(needed_tags.begin(), needed_tags.end(), tag) == needed_tags.end()) continue;
      if (!tags_.emplace(tag, read_values(tag, at)).second) {
        in_.fail("is corrupt: it has tag " + std::to_string(tag) + " twice");
      }
      std::copy_n(plain_.begin() + static_cast<std::ptrdiff_t>(at), entry_bytes,
                  plain_.begin() + static_cast<std::ptrdiff_t>(to));
      to += entry_bytes;
    }
    put(begin, static_cast<std::uint32_t>(tags_.size()), 2);
    put(to, 0, 4);
  }

  Values read_values(std::uint16_t tag, std::size_t entry) const {
    const std::uint32_t type = number(entry + 2, 2), count = number(entry + 4, 4);
    if (type != type_short && type != type_long) {
      in_.fail("has tag " + std::to_string(tag) + " of type " + std::to_string(type) +
               "; allowed: 3 and 4");
    }
    const std::size_t bytes = type == type_short ? 2 : 4;
    if (count == 0 || count > plain_.size() / bytes) {
      in_.fail("is corrupt: tag " + std::to_string(tag) + " has " + std::to_string(count) +
               " values");
    }
    const std::size_t at = count * bytes <= 4 ? entry + 8 : number(entry + 8, 4);
    Values values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = number(at + i * bytes, bytes);
    return values;
  }

  const Values& all(TiffTag tag) const {
    const auto it = tags_.find(tag);
    if (it == tags_.end()) in_.fail("is corrupt: it lacks tag " + std::to_string(tag));
    return it->second;
  }
  std::uint32_t one(TiffTag tag, std::uint32_t otherwise) const {
    const auto it = tags_.find(tag);
    return it == tags_.end() ? otherwise : it->second.front();
  }

  bool is_texture() const { return kind_ == Kind::texture; }

  void check_size() {
    width_ = all(image_width).front();
    height_ = all(image_length).front();
    in_.require_size(static_cast<std::int64_t>(width_), static_cast<std::int64_t>(height_),
                     is_texture() ? max_texture_side : max_picture_side,
                     is_texture() ? "texels" : "pixels");
  }

  void check_pixels() {
    check_size();
    samples_ = one(samples_per_pixel, 1);
    const bool with_alpha = is_texture() && samples_ == 2;
    if (samples_ != 1 && samples_ != 3 && samples_ != 4 && !with_alpha) {
      in_.fail("has " + std::to_string(samples_) + " channels; allowed: 1, " +
               (is_texture() ? "2, " : "") + "3, 4");
    }
    check_values();
    if (is_texture()) check_texture();
    const std::uint32_t coding = one(compression, 1), colours = one(photometric, 0);
    if (std::find(compressions.begin(), compressions.end(), coding) == compressions.end()) {
      in_.fail("has compression " + std::to_string(coding) +
               "; allowed: 1 (none), 5 (LZW), 8 and 32946 (Deflate), 32773 (PackBits)");
    }
    if (colours != 1 && colours != 2) {
      in_.fail("has photometric interpretation " + std::to_string(colours) +
               "; allowed: 1 (grey), 2 (RGB)");
    }
  }

  /// The type of the values.
  void check_values() {
    const Values& depths = all(bits_per_sample);
    bits_ = depths.front();
    const std::uint32_t format = one(sample_format, 1);
    constexpr std::uint32_t format_unsigned = 1;
    const bool right = is_texture() ? format == format_unsigned && (bits_ == 8 || bits_ == 16)
                                    : format == format_float && (bits_ == 16 || bits_ == 32);
    if (right &&
        std::all_of(depths.begin(), depths.end(), [&](std::uint32_t d) { return d == bits_; })) {
      return;
    }
    in_.fail("has " + std::to_string(bits_) + "-bit " +
             (format == format_float ? "floats" : "integers") + "; allowed: " +
             (is_texture() ? "8- and 16-bit unsigned integers" : "16- and 32-bit floats"));
  }

  /// Where texels stand, and that alpha is not multiplied into their colours.
  void check_texture() const {
    if (one(orientation, 1) != 1) {
      in_.fail("has orientation " + std::to_string(one(orientation, 1)) + "; allowed: 1");
    }
    constexpr std::uint32_t associated = 1;
    if (one(extra_samples, 0) == associated) {
      in_.fail("has alpha that is multiplied into its colours; allowed: unassociated alpha");
    }
  }

  /// Checks strips or tiles: the number that follows from the size, each inside the file.
  void check_data() const {
    const bool tiled = tags_.contains(tile_width);
    const std::uint64_t across = tiled ? all(tile_width).front() : width_;
    const std::uint64_t down =
        tiled ? all(tile_length).front()
              : std::min<std::uint64_t>(one(rows_per_strip, 0xffffffff), height_);
    if (across == 0 || down == 0 || across > max_picture_side || down > max_picture_side) {
      in_.fail("is corrupt: its blocks are " + std::to_string(across) + " x " +
               std::to_string(down) + " pixels");
    }
    const bool apart = one(planar_configuration, 1) == 2;
    const std::uint64_t blocks =
        (width_ + across - 1) / across * ((height_ + down - 1) / down) * (apart ? samples_ : 1);
    const Values& offsets = all(tiled ? tile_offsets : strip_offsets);
    const Values& lengths = all(tiled ? tile_bytes : strip_bytes);
    if (offsets.size() != blocks || lengths.size() != blocks) {
      in_.fail("is corrupt: it has " + std::to_string(offsets.size()) +
               " blocks, its size requires " + std::to_string(blocks));
    }
    std::uint64_t stored = 0;
    for (std::size_t i = 0; i < blocks; ++i) {
      if (std::uint64_t{offsets[i]} + lengths[i] > plain_.size()) {
        in_.fail("is corrupt: it ends early");
      }
      stored += lengths[i];
    }
    const std::uint64_t wanted = std::uint64_t{width_} * height_ * samples_ * bits_ / 8;
    const bool compressed = one(compression, 1) != 1;
    if (wanted > stored * (compressed ? largest_tiff_expansion : 1)) {
      in_.fail("is corrupt: " + std::to_string(stored) + " bytes cannot hold its " +
               std::to_string(width_) + " x " + std::to_string(height_) + " pixels");
    }
  }

  std::vector<std::uint8_t> plain_;
  CheckedBytes in_;
  Kind kind_;
  bool little_ = true;
  std::map<std::uint16_t, Values> tags_;
  std::uint32_t width_ = 0, height_ = 0, samples_ = 0, bits_ = 0;
};

}  // namespace

std::vector<std::uint8_t> plain_tiff(std::span<const std::uint8_t> tiff, const std::string& label) {
  return TiffGuard(tiff, label, TiffGuard::Kind::picture).run();
}

std::vector<std::uint8_t> plain_tiff_texture(std::span<const std::uint8_t> tiff,
                                             const std::string& label) {
  return TiffGuard(tiff, label, TiffGuard::Kind::texture).run();
}

std::uint64_t tiff_texels(std::span<const std::uint8_t> tiff, const std::string& label) {
  return TiffGuard(tiff, label, TiffGuard::Kind::texture).pixels();
}

}  // namespace lacuna
