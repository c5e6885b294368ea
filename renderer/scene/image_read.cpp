#include "renderer/scene/image_read.h"

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <optional>

#include "renderer/scene/exr_guard.h"
#include "renderer/scene/scene_data.h"

namespace lacuna {
namespace {

constexpr int max_side = 32768;
using ChannelIndices = std::array<int, 3>;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw SceneError(file.string() + ": " + what);
}

const char* format_of(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    fail(file, error ? error.message() : "is not a regular file");
  }
  std::array<char, 4> magic{};
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(file, "cannot be opened");
  stream.read(magic.data(), magic.size());
  if (magic == std::array<char, 4>{'\x76', '\x2f', '\x31', '\x01'}) return "openexr";
  if (magic[0] == '#' && magic[1] == '?') return "hdr";
  fail(file, "is neither OpenEXR nor Radiance HDR");
}

int channel_index(const OIIO::ImageSpec& spec, const std::string& name) {
  const auto it = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
  return it == spec.channelnames.end() ? -1 : static_cast<int>(it - spec.channelnames.begin());
}

std::array<std::string, 3> channel_names(const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  return {prefix + "R", prefix + "G", prefix + "B"};
}

std::optional<ChannelIndices> find_channels(const OIIO::ImageSpec& spec, const std::string& layer) {
  ChannelIndices rgb{};
  const auto names = channel_names(layer);
  std::transform(names.begin(), names.end(), rgb.begin(),
                 [&spec](const std::string& name) { return channel_index(spec, name); });
  if (*std::min_element(rgb.begin(), rgb.end()) >= 0) return rgb;
  const int grey = channel_index(spec, layer.empty() ? "Y" : layer + ".Y");
  if (grey >= 0) return ChannelIndices{grey, grey, grey};
  return std::nullopt;
}

[[noreturn]] void fail_for_channels(const std::filesystem::path& file, const OIIO::ImageSpec& spec,
                                    const std::string& layer) {
  std::string missing;
  for (const std::string& name : channel_names(layer)) {
    if (channel_index(spec, name) < 0) missing += (missing.empty() ? "" : ", ") + name;
  }
  fail(file,
       "lacks channel " + missing + "; it has " + OIIO::Strutil::join(spec.channelnames, ", "));
}

void check_spec(const std::filesystem::path& file, const OIIO::ImageSpec& spec) {
  if (spec.deep) fail(file, "is a deep image; allowed: flat ones");
  if (spec.width < 1 || spec.height < 1 || spec.width > max_side || spec.height > max_side) {
    fail(file, "is " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                   " pixels; allowed: up to " + std::to_string(max_side) + " a side");
  }
  if (spec.width != spec.full_width || spec.height != spec.full_height || spec.x != spec.full_x ||
      spec.y != spec.full_y) {
    fail(file, "is a crop (its data window is not its display window); allowed: whole images");
  }
  if (spec.get_int_attribute("Orientation", 1) != 1) {
    fail(file, "is stored turned or mirrored; allowed: top row first, left to right");
  }
}

}  // namespace

FloatImage read_float_image(const std::filesystem::path& file, const std::string& layer) {
  const std::string_view format = format_of(file);
  if (format == "openexr") check_exr_header(file);
  const auto in = OIIO::ImageInput::create(std::string(format));
  OIIO::ImageSpec spec;
  if (!in || !in->open(file.string(), spec)) {
    fail(file, "cannot be decoded: " + (in ? in->geterror() : OIIO::geterror()));
  }
  int part = 0;
  auto channels = find_channels(spec, layer);
  while (!channels && in->seek_subimage(++part, 0)) {
    spec = in->spec();
    channels = find_channels(spec, layer);
  }
  if (!channels) fail_for_channels(file, spec, layer);
  check_spec(file, spec);

  const auto [low, high] = std::minmax_element(channels->begin(), channels->end());
  const int channel_count = *high - *low + 1;
  const auto read = static_cast<std::size_t>(channel_count);
  const auto pixels = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  // Not set to zero: memory is used up only as pixels come, however large the header says they are.
  const auto stored = std::make_unique_for_overwrite<float[]>(pixels * read);
  if (!in->read_image(in->current_subimage(), 0, *low, *high + 1, OIIO::TypeDesc::FLOAT,
                      stored.get()) ||
      in->has_error()) {
    fail(file, "is corrupt: " + in->geterror());
  }
  FloatImage image{spec.width, spec.height, std::vector<float>(pixels * 3), {}};
  for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
    const std::string& name = attribute.name().string();
    if (name.starts_with("lacuna:")) image.attributes[name] = attribute.get_string();
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      image.rgb[3 * i + k] = stored[i * read + static_cast<std::size_t>((*channels)[k] - *low)];
    }
  }
  return image;
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
