#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <stdexcept>
#include <thread>

#include "renderer/images/image_codec.h"

// The only source that uses OpenImageIO: the image module.

namespace lacuna {
namespace {

namespace Io = OIIO::Filesystem;

const char* reader_name(ImageFormat format) {
  switch (format) {
    case ImageFormat::openexr:
      return "openexr";
    case ImageFormat::png:
      return "png";
    case ImageFormat::jpeg:
      return "jpeg";
    case ImageFormat::webp:
      return "webp";
    case ImageFormat::radiance_hdr:
      return "hdr";
    case ImageFormat::tiff:
      return "tiff";
  }
  throw std::runtime_error("unknown format");
}

/// Removes line ends at the end, and joins lines by semicolons.
[[noreturn]] void fail(std::string message) {
  while (!message.empty() && message.back() == '\n') message.pop_back();
  std::replace(message.begin(), message.end(), '\n', ';');
  throw std::runtime_error(message.empty() ? "unknown reason" : message);
}

std::unique_ptr<OIIO::ImageInput> reader_of(ImageFormat format) {
  auto reader = OIIO::ImageInput::create(reader_name(format));
  if (!reader) fail(OIIO::geterror());
  return reader;
}

/// Rejects a picture that was read with errors: the library fills in missing data of a JPEG and
/// only reports it.
void require_clean(const OIIO::ImageInput& reader, bool read) {
  if (!read || reader.has_error()) fail(reader.geterror());
}

OIIO::ImageSpec reading_hints() {
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  return hints;
}

PictureHeader header_of(const OIIO::ImageSpec& spec) {
  PictureHeader header;
  header.width = spec.width;
  header.height = spec.height;
  header.cropped = spec.x != spec.full_x || spec.y != spec.full_y ||
                   spec.width != spec.full_width || spec.height != spec.full_height;
  header.orientation = spec.get_int_attribute("Orientation", 1);
  header.channels = spec.channelnames;
  for (const OIIO::ParamValue& value : spec.extra_attribs) {
    if (value.type() == OIIO::TypeString) header.texts[value.name().string()] = value.get_string();
  }
  return header;
}

class OpenPicture final : public PictureFile {
 public:
  OpenPicture(ImageFormat format, std::span<const std::uint8_t> bytes)
      : memory_(std::make_unique<Io::IOMemReader>(bytes.data(), bytes.size())),
        reader_(reader_of(format)) {
    reader_->set_ioproxy(memory_.get());
    OIIO::ImageSpec spec;
    if (!reader_->open("memory", spec, reading_hints())) fail(reader_->geterror());
    do {
      parts_.push_back(header_of(reader_->spec()));
    } while (reader_->seek_subimage(static_cast<int>(parts_.size()), 0));
    reader_->geterror();  // clears the error of the end of the file
  }

  const std::vector<PictureHeader>& parts() const override { return parts_; }

  void read(std::size_t part, std::span<const int> channels, float* out) override {
    const auto stride = static_cast<OIIO::stride_t>(channels.size() * sizeof(float));
    const bool in_a_row = std::adjacent_find(channels.begin(), channels.end(), [](int a, int b) {
                            return b != a + 1;
                          }) == channels.end();
    const OIIO::ImageSpec spec = reader_->spec(static_cast<int>(part));
    const bool integers = std::any_of(channels.begin(), channels.end(), [&](int c) {
      return spec.channelformat(c) == OIIO::TypeUInt32;
    });
    if (in_a_row && !integers) {
      return read_range({part, channels.front(), channels.back() + 1}, OIIO::TypeFloat, out,
                        stride);
    }
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const bool integer = spec.channelformat(channels[c]) == OIIO::TypeUInt32;
      read_range({part, channels[c], channels[c] + 1}, integer ? OIIO::TypeUInt32 : OIIO::TypeFloat,
                 out + c, stride);
      if (integer) to_float(out + c, channels.size(), parts_[part]);
    }
  }

 private:
  struct ChannelRange {
    std::size_t part;
    int first, end;
  };
  void read_range(const ChannelRange& range, const OIIO::TypeDesc& type, void* out,
                  OIIO::stride_t stride) {
    const bool read = reader_->read_image(static_cast<int>(range.part), 0, range.first, range.end,
                                          type, out, stride);
    require_clean(*reader_, read);
  }

  /// Converts integers by value; the library would scale them to 0..1.
  static void to_float(float* values, std::size_t stride, const PictureHeader& header) {
    const std::size_t pixels =
        static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
    for (std::size_t i = 0; i < pixels; ++i) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, values + i * stride, sizeof bits);
      values[i * stride] = static_cast<float>(bits);
    }
  }

  std::unique_ptr<Io::IOMemReader> memory_;
  std::unique_ptr<OIIO::ImageInput> reader_;
  std::vector<PictureHeader> parts_;
};

/// Encodes the picture of `spec` by the named writer, which takes `rows` in blocks of `count`.
EncodedImage encode(const char* writer, const OIIO::ImageSpec& spec, int count,
                    const std::function<const void*(const RowBlock&)>& rows) {
  EncodedImage bytes;
  Io::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create(writer);
  if (!output) fail(OIIO::geterror());
  output->set_ioproxy(&memory);
  if (!output->open("memory", spec)) fail(output->geterror());
  for (int first = 0; first < spec.height; first += count) {
    const RowBlock block{first, std::min(count, spec.height - first)};
    if (!output->write_scanlines(first, first + block.count, 0, spec.format, rows(block))) {
      fail(output->geterror());
    }
  }
  if (!output->close()) fail(output->geterror());
  return bytes;
}

class OpenImageIoCodec final : public ImageCodec {
 public:
  OpenImageIoCodec() {
    OIIO::attribute("debug", 0);  // keeps Debian's build from reporting skipped data on stderr
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", no_threads);
    OIIO::attribute("plugin_searchpath", "");
    OIIO::attribute("try_all_readers", 0);
    OIIO::attribute("limits:channels", most_channels);
  }

  std::unique_ptr<PictureFile> open(ImageFormat format,
                                    std::span<const std::uint8_t> bytes) const override {
    return std::make_unique<OpenPicture>(format, bytes);
  }

  StoredTexels decode(ImageFormat format, std::span<const std::uint8_t> bytes) const override {
    Io::IOMemReader memory(bytes.data(), bytes.size());
    const auto reader = reader_of(format);
    reader->set_ioproxy(&memory);
    OIIO::ImageSpec spec;
    if (!reader->open("memory", spec, reading_hints())) fail(reader->geterror());
    const int bits = static_cast<int>(8 * spec.format.size());
    if (spec.format != OIIO::TypeUInt8 && spec.format != OIIO::TypeUInt16) {
      fail("its values have neither 8 nor 16 bits");
    }
    StoredTexels texels{spec.width, spec.height, spec.nchannels, bits, nullptr};
    // Not set to zero: memory is committed only as texels arrive.
    texels.values = std::make_unique_for_overwrite<std::uint8_t[]>(spec.image_bytes());
    require_clean(*reader,
                  reader->read_image(0, 0, 0, spec.nchannels, spec.format, texels.values.get()));
    return texels;
  }

  EncodedImage encode_exr(const ExrContent& content) const override {
    OIIO::ImageSpec spec(content.width, content.height, static_cast<int>(content.channels.size()),
                         content.half ? OIIO::TypeHalf : OIIO::TypeFloat);
    spec.channelnames = content.channels;
    spec.attribute("compression", "zip");
    for (const auto& [name, value] : content.texts) spec.attribute(name, value);
    // Without a date the library would write the time of day. It omits this one: EXR has no 64-bit
    // integers.
    const std::uint64_t no_date = 0;
    spec.attribute("DateTime", OIIO::TypeUInt64, &no_date);
    if (content.channels.size() * spec.image_pixels() > worth_threads) {
      OIIO::attribute("exr_threads", static_cast<int>(std::thread::hardware_concurrency()));
    }
    // Each block of 16 rows is compressed by its own thread.
    constexpr std::uint64_t unit = 16;
    const std::uint64_t units = most_block_bytes / (unit * spec.scanline_bytes(true));
    const std::uint64_t rows = unit * std::max<std::uint64_t>(1, units);
    return encode("openexr", spec,
                  static_cast<int>(std::min<std::uint64_t>(rows, std::max(1, content.height))),
                  content.rows);
  }

  EncodedImage encode_png(int width, int height,
                          std::span<const std::uint8_t> values) const override {
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const bool alpha = values.size() == 4 * pixels;
    OIIO::ImageSpec spec(width, height, alpha ? 4 : 3, OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    if (alpha) spec.attribute("oiio:UnassociatedAlpha", 1);
    return encode("png", spec, height, [&](const RowBlock&) { return values.data(); });
  }

 private:
  static constexpr int no_threads = -1;  // zero would mean one per core
  /// Strategy layers of long paths: 3 for each pair of up to 128 and 128 vertices.
  static constexpr int most_channels = 1 << 16;
  /// The number of values from which compression takes longer than starting threads.
  static constexpr std::size_t worth_threads = std::size_t{1} << 20;
  /// The size of a block of rows: larger ones would not use more threads.
  static constexpr std::uint64_t most_block_bytes = std::uint64_t{16} << 20;
};

}  // namespace
}  // namespace lacuna

// Never destroyed: a thread may still write a picture while the process ends.
extern "C" __attribute__((visibility("default"))) const lacuna::ImageCodec* lacuna_image_codec() {
  static const auto* const codec = new lacuna::OpenImageIoCodec;
  return codec;
}
