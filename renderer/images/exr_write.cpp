#include "renderer/images/exr_write.h"

#include <Imath/half.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/storage/atomic_file.h"
#include "base/storage/bytes.h"
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

/// Apart from the job's attributes, the same in every file.
std::map<std::string, std::string> header_texts(
    const std::map<std::string, std::string>& attributes) {
  std::map<std::string, std::string> texts{{"Software", "lacuna"}};
  for (const auto& [name, value] : attributes) texts["lacuna:" + name] = value;
  return texts;
}

void require_halves(const std::filesystem::path& file, const std::vector<ExrLayer>& layers) {
  for (const ExrLayer& layer : layers) {
    for (std::size_t i = 0; i < layer.size(); ++i) {
      const double v = layer.value(i);
      if (!(std::abs(v) > largest_half)) continue;
      throw std::runtime_error(
          fmt::format("{}: a value of {} does not fit half precision (at most {}); set "
                      "\"pixel_type\": \"float\"",
                      file.string(), v, largest_half));
    }
  }
}

/// Some rows of all layers, their channels interleaved.
template <class T>
void interleave(const ExrPicture& picture, const RowBlock& rows, std::vector<T>& all) {
  const auto width = static_cast<std::size_t>(picture.width);
  const std::size_t before = width * static_cast<std::size_t>(rows.first);
  const std::size_t pixels = width * static_cast<std::size_t>(rows.count);
  const std::size_t channels = all.size() / pixels;
  std::size_t first = 0;
  for (const ExrLayer& layer : picture.layers) {
    const std::size_t own = layer.channels.size();
    for (std::size_t p = 0; p < pixels; ++p) {
      for (std::size_t c = 0; c < own; ++c) {
        const double v = layer.value((before + p) * own + c);
        all[p * channels + first + c] = static_cast<float>(v);
      }
    }
    first += own;
  }
}

template <class T>
EncodedImage encode_as(const std::filesystem::path& file, const ExrPicture& picture,
                       const std::function<void()>& between) {
  std::vector<T> values;
  ExrContent content{picture.width,
                     picture.height,
                     exr_channel_names(picture.layers),
                     std::is_same_v<T, half>,
                     {},
                     header_texts(picture.attributes)};
  const std::size_t row = static_cast<std::size_t>(picture.width) * content.channels.size();
  content.rows = [&](const RowBlock& rows) {
    if (between && rows.first > 0) between();
    values.resize(row * static_cast<std::size_t>(rows.count));
    interleave<T>(picture, rows, values);
    return values.data();
  };
  const ImageCodec& codec = image_codec();
  try {
    return codec.encode_exr(content);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), e.what()));
  }
}

}  // namespace

void write_exr(const std::filesystem::path& file, const ExrPicture& picture,
               const std::function<void()>& between) {
  if (picture.type == PixelType::half_float) require_halves(file, picture.layers);
  const EncodedImage bytes = picture.type == PixelType::half_float
                                 ? encode_as<half>(file, picture, between)
                                 : encode_as<float>(file, picture, between);
  AtomicFile out(file);
  std::string_view left(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (; !left.empty(); left.remove_prefix(std::min(left.size(), piece_bytes))) {
    if (between) between();
    out.write(left.substr(0, piece_bytes));
  }
  out.commit();
}

}  // namespace lacuna
