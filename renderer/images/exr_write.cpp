#include "renderer/images/exr_write.h"

#include <Imath/half.h>
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "analysis/storage/atomic_file.h"
#include "renderer/images/image_module.h"

namespace lacuna {

namespace {

constexpr double largest_half = 65504;

std::vector<std::string> exr_channel_names(const std::vector<ExrLayer>& layers) {
  std::vector<std::string> names;
  for (const ExrLayer& layer : layers) {
    for (const std::string& channel : layer.channels) {
      names.push_back(layer.name.empty() ? channel : layer.name + "." + channel);
    }
  }
  return names;
}

/// Beside what a job tells, nothing that differs from one writing to the next.
std::map<std::string, std::string> header_texts(
    const std::map<std::string, std::string>& attributes) {
  std::map<std::string, std::string> texts{{"Software", "lacuna"}};
  for (const auto& [name, value] : attributes) texts["lacuna:" + name] = value;
  return texts;
}

template <class T>
std::vector<T> interleave(std::size_t pixels, const std::vector<ExrLayer>& layers,
                          std::size_t channels, const std::filesystem::path& file) {
  std::vector<T> all(pixels * channels);
  std::size_t first = 0;
  for (const ExrLayer& layer : layers) {
    const std::size_t own = layer.channels.size();
    for (std::size_t p = 0; p < pixels; ++p) {
      for (std::size_t c = 0; c < own; ++c) {
        const double v = layer.values[p * own + c];
        if (std::is_same_v<T, half> && std::abs(v) > largest_half) {
          throw std::runtime_error(
              fmt::format("{}: a value of {} does not fit half precision (at most {}); ask for "
                          "\"pixel_type\": \"float\"",
                          file.string(), v, largest_half));
        }
        all[p * channels + first + c] = static_cast<float>(v);
      }
    }
    first += own;
  }
  return all;
}

template <class T>
EncodedImage encode_as(const std::filesystem::path& file, const ExrPicture& picture) {
  ExrContent content{picture.width,           picture.height, exr_channel_names(picture.layers),
                     std::is_same_v<T, half>, nullptr,        header_texts(picture.attributes)};
  const std::size_t pixels =
      static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  const std::vector<T> values =
      interleave<T>(pixels, picture.layers, content.channels.size(), file);
  content.values = values.data();
  const ImageCodec& codec = image_codec();
  try {
    return codec.encode_exr(content);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), e.what()));
  }
}

}  // namespace

void write_exr(const std::filesystem::path& file, const ExrPicture& picture) {
  const EncodedImage bytes = picture.type == PixelType::half_float
                                 ? encode_as<half>(file, picture)
                                 : encode_as<float>(file, picture);
  write_file_atomically(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace lacuna
