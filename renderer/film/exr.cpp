#include "renderer/film/exr.h"

#include <Imath/half.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <cstring>
#include <stdexcept>
#include <thread>

#include "analysis/storage/atomic_file.h"

namespace lacuna {

namespace {

constexpr double largest_half = 65504;

/// A file in memory.
class MemoryFile final : public Imf::OStream {
 public:
  MemoryFile() : OStream("memory") {}
  void write(const char* bytes, int n) override {
    const auto size = static_cast<std::size_t>(n);
    if (at_ + size > bytes_.size()) bytes_.resize(at_ + size);
    std::memcpy(bytes_.data() + at_, bytes, size);
    at_ += size;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

std::vector<std::string> channel_names(const std::vector<ExrLayer>& layers) {
  std::vector<std::string> names;
  for (const ExrLayer& layer : layers) {
    for (const std::string& channel : layer.channels) {
      names.push_back(layer.name.empty() ? channel : layer.name + "." + channel);
    }
  }
  return names;
}

Imf::Header make_header(int width, int height, const std::vector<std::string>& channels,
                        Imf::PixelType type, const std::map<std::string, std::string>& attributes) {
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const std::string& name : channels) header.channels().insert(name, Imf::Channel(type));
  header.insert("Software", Imf::StringAttribute("lacuna"));
  for (const auto& [name, value] : attributes) {
    header.insert("lacuna:" + name, Imf::StringAttribute(value));
  }
  return header;
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
void write_as(Imf::PixelType type, MemoryFile& out, const std::filesystem::path& file, int width,
              int height, const std::vector<ExrLayer>& layers,
              const std::map<std::string, std::string>& attributes) {
  const std::vector<std::string> names = channel_names(layers);
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<T> values = interleave<T>(pixels, layers, names.size(), file);
  const std::size_t x_stride = names.size() * sizeof(T);
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < names.size(); ++c) {
    frame.insert(names[c], Imf::Slice(type, reinterpret_cast<char*>(values.data() + c), x_stride,
                                      x_stride * static_cast<std::size_t>(width)));
  }
  // Threads compress, where that takes longer than to start them.
  constexpr std::size_t worthwhile = std::size_t{1} << 20;
  if (values.size() > worthwhile && Imf::globalThreadCount() == 0) {
    Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
  }
  Imf::OutputFile image(out, make_header(width, height, names, type, attributes));
  image.setFrameBuffer(frame);
  image.writePixels(height);
}

}  // namespace

void write_exr(const std::filesystem::path& file, int width, int height,
               const std::vector<ExrLayer>& layers, PixelType type,
               const std::map<std::string, std::string>& attributes) {
  MemoryFile out;
  try {
    if (type == PixelType::half_float) {
      write_as<half>(Imf::HALF, out, file, width, height, layers, attributes);
    } else {
      write_as<float>(Imf::FLOAT, out, file, width, height, layers, attributes);
    }
  } catch (const Iex::BaseExc& e) {
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), e.what()));
  }
  write_file_atomically(file, out.bytes());
}

}  // namespace lacuna
