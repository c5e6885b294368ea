#include "renderer/images/image_read.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <optional>
#include <stdexcept>

#include "analysis/storage/available_memory.h"
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

/// The format by the magic bytes, whatever the file's name; none for an unsupported format.
std::optional<ImageFormat> format_of(const ReadFile& file) {
  const std::string_view text(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size());
  using namespace std::string_view_literals;
  if (text.starts_with("\x76\x2f\x31\x01"sv)) return ImageFormat::openexr;
  if (text.starts_with("#?")) return ImageFormat::radiance_hdr;
  if (text.starts_with("II*\0"sv) || text.starts_with("MM\0*"sv)) return ImageFormat::tiff;
  return std::nullopt;
}

std::array<std::string, 3> channel_names(const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  return {prefix + "R", prefix + "G", prefix + "B"};
}

/// The channels of a layer: three, or one that is grey; none if the layer is missing.
std::vector<int> find_channels(const PictureHeader& header, const std::string& layer) {
  const auto place = [&](const std::string& name) {
    const auto it = std::find(header.channels.begin(), header.channels.end(), name);
    return it == header.channels.end() ? -1 : static_cast<int>(it - header.channels.begin());
  };
  std::vector<int> places;
  for (const std::string& name : channel_names(layer)) places.push_back(place(name));
  if (std::find(places.begin(), places.end(), -1) == places.end()) return places;
  const int grey = place(layer.empty() ? "Y" : layer + ".Y");
  if (grey >= 0) return {grey};
  return {};
}

[[noreturn]] void fail_for_channels(const std::filesystem::path& file, const PictureHeader& header,
                                    const std::string& layer) {
  std::vector<std::string> missing;
  for (const std::string& name : channel_names(layer)) {
    if (std::find(header.channels.begin(), header.channels.end(), name) == header.channels.end()) {
      missing.push_back(name);
    }
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
    fail(file, "is stored turned or mirrored; allowed: top row first, left to right");
  }
}

FloatImage read_part(PictureFile& in, std::size_t part, const std::vector<int>& channels) {
  const PictureHeader& header = in.parts()[part];
  const std::size_t pixels =
      static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
  const std::size_t read = channels.size();
  // Not set to zero: memory is used up only as pixels come, however large the header says they are.
  const auto stored = std::make_unique_for_overwrite<float[]>(pixels * read);
  in.read(part, channels, stored.get());
  FloatImage result{header.width, header.height, std::vector<float>(pixels * 3), {}, {}};
  for (const auto& [name, text] : header.texts) {
    if (name.starts_with("lacuna:")) result.attributes[name] = text;
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      result.rgb[3 * i + k] = stored[i * read + (read == 3 ? k : 0)];
    }
  }
  return result;
}

FloatImage read_layer(const std::filesystem::path& file, PictureFile& in,
                      const std::string& layer) {
  for (std::size_t part = 0; part < in.parts().size(); ++part) {
    const std::vector<int> channels = find_channels(in.parts()[part], layer);
    if (channels.empty()) continue;
    check_header(file, in.parts()[part]);
    return read_part(in, part, channels);
  }
  fail_for_channels(file, in.parts().front(), layer);
}

/// The guards come first; without a picture in the file the module is not even loaded.
FloatImage read_as(ImageFormat format, ReadFile file, const std::string& layer) {
  const std::string label = file.path.string();
  if (format == ImageFormat::openexr) {
    check_exr_header(file.bytes, label);
  } else if (format == ImageFormat::tiff) {
    file.bytes = plain_tiff(file.bytes, label);
  } else {
    file.bytes = plain_hdr(file.bytes, label);
  }
  const ImageCodec& codec = image_codec();
  try {
    FloatImage image = read_layer(file.path, *codec.open(format, file.bytes), layer);
    image.file = std::move(file.about);
    return image;
  } catch (const SceneError&) {
    throw;
  } catch (const std::runtime_error& e) {
    fail(file.path, std::string("is corrupt: ") + e.what());
  }
}

}  // namespace

FloatImage read_float_image(const std::filesystem::path& path, const std::string& layer) {
  ReadFile file = read_all(path);
  const auto format = format_of(file);
  if (!format || *format == ImageFormat::tiff) fail(path, "is neither OpenEXR nor Radiance HDR");
  return read_as(*format, std::move(file), layer);
}

FloatImage read_reference_image(const std::filesystem::path& path) {
  ReadFile file = read_all(path);
  const auto format = format_of(file);
  if (!format) fail(path, "is neither OpenEXR nor Radiance HDR nor TIFF");
  return read_as(*format, std::move(file), "");
}

void require_radiance(const FloatImage& image, const std::string& label) {
  const auto bad = [](float v) { return !(v >= 0) || !std::isfinite(v); };
  const auto it = std::find_if(image.rgb.begin(), image.rgb.end(), bad);
  if (it == image.rgb.end()) return;
  const auto i = static_cast<std::size_t>(it - image.rgb.begin());
  const auto pixel = i / 3;
  const auto width = static_cast<std::size_t>(image.width);
  throw SceneError(label + ": pixel (" + std::to_string(pixel % width) + ", " +
                   std::to_string(pixel / width) + ") channel " + "RGB"[i % 3] + " is " +
                   std::to_string(*it) + "; allowed: finite, at least 0");
}

}  // namespace lacuna
