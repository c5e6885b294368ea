#include "renderer/images/image_read.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <optional>
#include <stdexcept>

#include "base/storage/available_memory.h"
#include "renderer/core/scene_error.h"
#include "renderer/images/guards.h"
#include "renderer/images/image_module.h"

namespace lacuna {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw SceneError(file.string() + ": " + what);
}

/// A file that was read as a whole.
struct ReadFile {
  std::filesystem::path path;
  InputBytes bytes;
  InputFile about;
};

ReadFile read_all(const std::filesystem::path& path) {
  ReadFile file{path, {}, {}};
  try {
    file.bytes = read_input(path, memory_to_take(), file.about);
  } catch (const std::length_error&) {
    throw std::bad_alloc();
  } catch (const std::invalid_argument& e) {
    fail(path, e.what());
  }
  return file;
}

/// The format by the magic bytes, regardless of the file's name; none for an unsupported format.
std::optional<ImageFormat> format_of(const ReadFile& file) {
  const std::string_view text(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size());
  using namespace std::string_view_literals;
  if (text.starts_with("\x76\x2f\x31\x01"sv)) return ImageFormat::openexr;
  if (text.starts_with("#?")) return ImageFormat::radiance_hdr;
  if (text.starts_with("II*\0"sv) || text.starts_with("MM\0*"sv)) return ImageFormat::tiff;
  return std::nullopt;
}

/// The channels of a layer with its colours.
struct ColourChannels {
  std::vector<int> indices;  ///< three, or one for grey; empty if the layer is missing
  bool xyz = false;
  int alpha = -1;  ///< -1: none
};

/// The index of a layer's channel; -1 if it is missing.
int channel_index(const PictureHeader& header, const std::string& layer, const std::string& name) {
  const auto it = std::find(header.channels.begin(), header.channels.end(),
                            layer.empty() ? name : layer + "." + name);
  return it == header.channels.end() ? -1 : static_cast<int>(it - header.channels.begin());
}

ColourChannels find_channels(const PictureHeader& header, const std::string& layer) {
  const auto index_of = [&](const char* name) { return channel_index(header, layer, name); };
  for (const auto& names : {std::array{"R", "G", "B"}, std::array{"X", "Y", "Z"}}) {
    const std::vector<int> indices{index_of(names[0]), index_of(names[1]), index_of(names[2])};
    if (*std::min_element(indices.begin(), indices.end()) >= 0) {
      return {indices, *names[0] == 'X', index_of("A")};
    }
  }
  // Y alone is grey; beside these it is one channel of a colour. Z alone is depth.
  const auto parts = {"R", "G", "B", "X", "RY", "BY"};
  const bool alone =
      std::all_of(parts.begin(), parts.end(), [&](auto* p) { return index_of(p) < 0; });
  if (alone && index_of("Y") >= 0) return {{index_of("Y")}, false, index_of("A")};
  return {};
}

[[noreturn]] void fail_for_channels(const std::filesystem::path& file, const PictureHeader& header,
                                    const std::string& layer) {
  std::vector<std::string> missing;
  for (const std::string name : {"R", "G", "B"}) {
    if (channel_index(header, layer, name) >= 0) continue;
    missing.push_back(layer.empty() ? name : layer + "." + name);
  }
  fail(file, fmt::format("lacks channel {}; it has {}", fmt::join(missing, ", "),
                         fmt::join(header.channels, ", ")));
}

void check_header(const std::filesystem::path& file, const PictureHeader& header) {
  if (header.width < 1 || header.height < 1 || header.width > max_picture_side ||
      header.height > max_picture_side) {
    fail(file, fmt::format("is {} x {} pixels; allowed: up to {} a side", header.width,
                           header.height, max_picture_side));
  }
  if (header.cropped) {
    fail(file, "is a crop (its data window is not its display window); allowed: whole images");
  }
  if (header.orientation != 1) {
    fail(file, "is stored rotated or mirrored; allowed: top row first, left to right");
  }
}

/// Linear RGB of Rec. 709 from CIE XYZ: the inverse of the matrix whose columns are the primaries,
/// scaled to sum to the white (ITU-R BT.709-6; SMPTE RP 177). Negative values within the rounding
/// error of half precision become 0: at most 2^-11 of the largest of X, Y, Z times the sum of a
/// row's magnitudes, 5.28.
Rgb rgb_of_xyz(const Rgb& xyz) {
  constexpr std::array<std::array<float, 3>, 3> matrix{{{3.2409699F, -1.5373832F, -0.4986108F},
                                                        {-0.9692436F, 1.8759675F, 0.0415551F},
                                                        {0.0556301F, -0.2039770F, 1.0569715F}}};
  const float rounding = 5.28F * 0x1p-11F * std::max({xyz.x, xyz.y, xyz.z});
  Rgb rgb;
  for (int k = 0; k < 3; ++k) {
    const auto& row = matrix[static_cast<std::size_t>(k)];
    rgb[k] = row[0] * xyz.x + row[1] * xyz.y + row[2] * xyz.z;
    if (rgb[k] < 0 && rgb[k] >= -rounding) rgb[k] = 0;
  }
  return rgb;
}

FloatImage read_part(PictureFile& in, std::size_t part, const ColourChannels& colours) {
  const PictureHeader& header = in.parts()[part];
  const std::size_t pixels =
      static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
  const std::size_t read = colours.indices.size();
  // Not set to zero: memory is committed only as pixels arrive, however large the header's size.
  const auto stored = std::make_unique_for_overwrite<float[]>(pixels * read);
  in.read(part, colours.indices, stored.get());
  FloatImage result{header.width, header.height, std::vector<float>(pixels * 3), {}, {}, {}};
  for (const auto& [name, text] : header.texts) {
    if (name.starts_with("lacuna:")) result.attributes[name] = text;
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      result.rgb[3 * i + k] = stored[i * read + (read == 3 ? k : 0)];
    }
    if (!colours.xyz) continue;
    float* const pixel = &result.rgb[3 * i];
    const Rgb rgb = rgb_of_xyz({pixel[0], pixel[1], pixel[2]});
    std::copy_n(&rgb.x, 3, pixel);
  }
  if (colours.alpha >= 0) {
    const std::array alpha{colours.alpha};
    in.read(part, alpha, stored.get());
    result.least_alpha = *std::min_element(stored.get(), stored.get() + pixels);
  }
  return result;
}

FloatImage read_layer(const std::filesystem::path& file, PictureFile& in,
                      const std::string& layer) {
  for (std::size_t part = 0; part < in.parts().size(); ++part) {
    const ColourChannels channels = find_channels(in.parts()[part], layer);
    if (channels.indices.empty()) continue;
    check_header(file, in.parts()[part]);
    return read_part(in, part, channels);
  }
  fail_for_channels(file, in.parts().front(), layer);
}

/// Validates first: a file without a picture does not even load the module.
FloatImage read_as(ImageFormat format, ReadFile file, const std::string& layer) {
  const std::string label = file.path.string();
  std::array<double, 3> multiplied{1, 1, 1};
  if (format == ImageFormat::openexr) {
    check_exr_header(file.bytes, label);
  } else if (format == ImageFormat::tiff) {
    file.bytes = plain_tiff(file.bytes, label);
  } else {
    PlainHdr plain = plain_hdr(file.bytes, label);
    file.bytes = std::move(plain.bytes);
    multiplied = plain.multiplied;
  }
  const ImageCodec& codec = image_codec();
  try {
    FloatImage image = read_layer(file.path, *codec.open(format, file.bytes), layer);
    image.file = std::move(file.about);
    if (multiplied == std::array<double, 3>{1, 1, 1}) return image;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
      image.rgb[i] = static_cast<float>(double{image.rgb[i]} / multiplied[i % 3]);
    }
    return image;
  } catch (const SceneError&) {
    throw;
  } catch (const std::runtime_error& e) {
    fail(file.path, std::string("is corrupt: ") + e.what());
  }
}

bool is_pfm(const ReadFile& file) {
  return file.bytes.size() > 2 && file.bytes[0] == 'P' &&
         (file.bytes[1] == 'F' || file.bytes[1] == 'f');
}

FloatImage read_any(ReadFile file, const std::string& layer, bool tiff) {
  if (is_pfm(file)) {
    if (!layer.empty()) fail(file.path, fmt::format("is a PFM, without a layer \"{}\"", layer));
    FloatImage image = read_pfm(file.bytes, file.path.string());
    image.file = std::move(file.about);
    return image;
  }
  const auto format = format_of(file);
  if (!format || (*format == ImageFormat::tiff && !tiff)) {
    fail(file.path,
         fmt::format("is neither OpenEXR nor Radiance HDR nor PFM{}", tiff ? " nor TIFF" : ""));
  }
  return read_as(*format, std::move(file), layer);
}

/// Throws SceneError if a value is not `good`.
template <class Good>
void require(const FloatImage& image, const std::string& label, const char* allowed, Good good) {
  const auto it = std::find_if_not(image.rgb.begin(), image.rgb.end(), good);
  if (it == image.rgb.end()) return;
  const auto i = static_cast<std::size_t>(it - image.rgb.begin());
  const auto bad = image.rgb.end() - it - std::count_if(it, image.rgb.end(), good);
  const auto width = static_cast<std::size_t>(image.width);
  throw SceneError(fmt::format(
      "{}: pixel ({}, {}) channel {} is {}, the first of {} such values of {}; allowed: {}", label,
      i / 3 % width, i / 3 / width, "RGB"[i % 3], *it, bad, image.rgb.size(), allowed));
}

}  // namespace

FloatImage read_float_image(const std::filesystem::path& path, const std::string& layer) {
  return read_any(read_all(path), layer, false);
}

FloatImage read_reference_image(const std::filesystem::path& path, const std::string& layer) {
  return read_any(read_all(path), layer, true);
}

void require_radiance(const FloatImage& image, const std::string& label) {
  require(image, label, "finite, at least 0", [](float v) { return v >= 0 && std::isfinite(v); });
}

void require_finite(const FloatImage& image, const std::string& label) {
  require(image, label, "finite", [](float v) { return std::isfinite(v); });
}

}  // namespace lacuna
