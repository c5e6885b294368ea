#include "renderer/scene/image_read.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>

#include "renderer/scene/exr_guard.h"
#include "renderer/scene/radiance_hdr.h"
#include "renderer/scene/scene_data.h"

namespace lacuna {
namespace {

constexpr int max_side = 32768;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw SceneError(file.string() + ": " + what);
}

enum class Format { exr, hdr };

Format format_of(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    fail(file, error ? error.message() : "is not a regular file");
  }
  std::array<char, 4> magic{};
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(file, "cannot be opened");
  stream.read(magic.data(), magic.size());
  if (magic == std::array<char, 4>{'\x76', '\x2f', '\x31', '\x01'}) return Format::exr;
  if (magic[0] == '#' && magic[1] == '?') return Format::hdr;
  fail(file, "is neither OpenEXR nor Radiance HDR");
}

std::array<std::string, 3> channel_names(const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  return {prefix + "R", prefix + "G", prefix + "B"};
}

/// The channels of a layer: three, or one that is grey; none if it is not there.
std::vector<std::string> find_channels(const Imf::Header& header, const std::string& layer) {
  const auto has = [&](const std::string& name) {
    return header.channels().findChannel(name) != nullptr;
  };
  const auto rgb = channel_names(layer);
  if (std::all_of(rgb.begin(), rgb.end(), has)) return {rgb.begin(), rgb.end()};
  const std::string grey = layer.empty() ? "Y" : layer + ".Y";
  if (has(grey)) return {grey};
  return {};
}

[[noreturn]] void fail_for_channels(const std::filesystem::path& file, const Imf::Header& header,
                                    const std::string& layer) {
  std::vector<std::string> missing, there;
  for (const std::string& name : channel_names(layer)) {
    if (header.channels().findChannel(name) == nullptr) missing.push_back(name);
  }
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    there.emplace_back(it.name());
  }
  fail(file, fmt::format("lacks channel {}; it has {}", fmt::join(missing, ", "),
                         fmt::join(there, ", ")));
}

void check_header(const std::filesystem::path& file, const Imf::Header& header,
                  const std::vector<std::string>& channels) {
  if (header.hasType() && Imf::isDeepData(header.type())) {
    fail(file, "is a deep image; allowed: flat ones");
  }
  const Imath::Box2i& data = header.dataWindow();
  const std::int64_t width = std::int64_t{data.max.x} - data.min.x + 1,
                     height = std::int64_t{data.max.y} - data.min.y + 1;
  if (width < 1 || height < 1 || width > max_side || height > max_side) {
    fail(file, fmt::format("is {} x {} pixels; allowed: up to {} a side", width, height, max_side));
  }
  if (data != header.displayWindow()) {
    fail(file, "is a crop (its data window is not its display window); allowed: whole images");
  }
  for (const std::string& name : channels) {
    const Imf::Channel& channel = header.channels()[name];
    if (channel.xSampling != 1 || channel.ySampling != 1) {
      fail(file, "has channel " + name + " at less than full resolution");
    }
  }
  const auto* turned = header.findTypedAttribute<Imf::IntAttribute>("Orientation");
  if (turned != nullptr && turned->value() != 1) {
    fail(file, "is stored turned or mirrored; allowed: top row first, left to right");
  }
}

std::map<std::string, std::string> own_attributes(const Imf::Header& header) {
  std::map<std::string, std::string> attributes;
  for (auto it = header.begin(); it != header.end(); ++it) {
    const std::string name = it.name();
    if (!name.starts_with("lacuna:")) continue;
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
    if (text != nullptr) attributes[name] = text->value();
  }
  return attributes;
}

FloatImage read_part(const std::filesystem::path& file, Imf::MultiPartInputFile& in, int part,
                     const std::vector<std::string>& channels) {
  const Imf::Header& header = in.header(part);
  check_header(file, header, channels);
  const Imath::Box2i& window = header.dataWindow();
  const Imath::V2i size = window.max - window.min + Imath::V2i(1);
  const auto width = static_cast<std::size_t>(size.x), height = static_cast<std::size_t>(size.y);
  const std::size_t pixels = width * height, read = channels.size();
  // Not set to zero: memory is used up only as pixels come, however large the header says they are.
  const auto stored = std::make_unique_for_overwrite<float[]>(pixels * read);
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < read; ++c) {
    frame.insert(channels[c], Imf::Slice::Make(Imf::FLOAT, stored.get() + c, window,
                                               read * sizeof(float), read * sizeof(float) * width));
  }
  Imf::InputPart image(in, part);
  image.setFrameBuffer(frame);
  image.readPixels(window.min.y, window.max.y);
  FloatImage result{size.x, size.y, std::vector<float>(pixels * 3), own_attributes(header)};
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      result.rgb[3 * i + k] = stored[i * read + (read == 3 ? k : 0)];
    }
  }
  return result;
}

FloatImage read_exr(const std::filesystem::path& file, const std::string& layer) {
  check_exr_header(file);
  try {
    Imf::Header::setMaxImageSize(max_side, max_side);  // before the library makes room for rows
    Imf::MultiPartInputFile in(file.c_str(), 0);
    for (int part = 0; part < in.parts(); ++part) {
      const auto channels = find_channels(in.header(part), layer);
      if (!channels.empty()) return read_part(file, in, part, channels);
    }
    fail_for_channels(file, in.header(0), layer);
  } catch (const Iex::BaseExc& e) {
    fail(file, std::string("is corrupt: ") + e.what());
  }
}

}  // namespace

FloatImage read_float_image(const std::filesystem::path& file, const std::string& layer) {
  return format_of(file) == Format::exr ? read_exr(file, layer) : read_radiance_hdr(file, max_side);
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
