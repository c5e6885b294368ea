#include "renderer/film/exr.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <stdexcept>

#include "renderer/film/write_whole.h"

namespace lacuna {

namespace {

constexpr double largest_half = 65504;

OIIO::ImageSpec make_spec(int width, int height, const std::vector<ExrLayer>& layers,
                          PixelType type, const std::map<std::string, std::string>& attributes) {
  OIIO::ImageSpec spec(
      width, height, 0,
      type == PixelType::half_float ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  for (const ExrLayer& layer : layers) {
    for (const std::string& channel : layer.channels) {
      spec.channelnames.push_back(layer.name.empty() ? channel : layer.name + "." + channel);
    }
  }
  spec.nchannels = static_cast<int>(spec.channelnames.size());
  spec.attribute("compression", "zip");
  // OpenImageIO writes the time of day if none is given: the same picture would be another file.
  spec.attribute("DateTime", "");
  spec.attribute("Software", "lacuna");
  for (const auto& [name, value] : attributes) spec.attribute("lacuna:" + name, value);
  return spec;
}

std::vector<float> interleave(std::size_t pixels, const std::vector<ExrLayer>& layers,
                              PixelType type, int channels, const std::filesystem::path& file) {
  std::vector<float> all(pixels * static_cast<std::size_t>(channels));
  std::size_t first = 0;
  for (const ExrLayer& layer : layers) {
    const std::size_t own = layer.channels.size();
    for (std::size_t p = 0; p < pixels; ++p) {
      for (std::size_t c = 0; c < own; ++c) {
        const double v = layer.values[p * own + c];
        if (type == PixelType::half_float && std::abs(v) > largest_half) {
          throw std::runtime_error(
              fmt::format("{}: a value of {} does not fit half precision (at most {}); ask for "
                          "\"pixel_type\": \"float\"",
                          file.string(), v, largest_half));
        }
        all[p * static_cast<std::size_t>(channels) + first + c] = static_cast<float>(v);
      }
    }
    first += own;
  }
  return all;
}

}  // namespace

void write_exr(const std::filesystem::path& file, int width, int height,
               const std::vector<ExrLayer>& layers, PixelType type,
               const std::map<std::string, std::string>& attributes) {
  const OIIO::ImageSpec spec = make_spec(width, height, layers, type, attributes);
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const std::vector<float> values = interleave(pixels, layers, type, spec.nchannels, file);
  write_whole(file, "openexr", spec, OIIO::TypeDesc::FLOAT, values.data());
}

}  // namespace lacuna
