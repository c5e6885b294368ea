#include "renderer/scene/texture_decode.h"

#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "renderer/scene/scene_data.h"

namespace lacuna {
namespace {

constexpr int max_side = 16384;

class Decoder {
 public:
  Decoder(std::span<const std::uint8_t> encoded, const std::string& label)
      : encoded_(encoded), label_(label) {}
  Decoder(const Decoder&) = delete;
  virtual ~Decoder() = default;
  virtual Rgba8Image decode() = 0;

 protected:
  [[noreturn]] void fail(const std::string& what) const { throw SceneError(label_ + ": " + what); }

  /// Room for the texels. Not set to zero: memory is used up only as they come, however large the
  /// header says they are.
  std::unique_ptr<std::uint8_t[]> room_for(std::int64_t width, std::int64_t height) {
    if (width < 1 || height < 1 || width > max_side || height > max_side) {
      fail("is " + std::to_string(width) + " x " + std::to_string(height) +
           " texels; allowed: up to " + std::to_string(max_side) + " a side");
    }
    image_.width = static_cast<int>(width);
    image_.height = static_cast<int>(height);
    return std::make_unique_for_overwrite<std::uint8_t[]>(bytes());
  }
  std::size_t bytes() const {
    return std::size_t{4} * static_cast<std::size_t>(image_.width) *
           static_cast<std::size_t>(image_.height);
  }
  Rgba8Image whole(const std::unique_ptr<std::uint8_t[]>& rgba) {
    image_.rgba.assign(rgba.get(), rgba.get() + bytes());
    return std::move(image_);
  }

  std::span<const std::uint8_t> encoded_;

 private:
  const std::string& label_;
  Rgba8Image image_;
};

/// By libpng. Its errors leave it as exceptions; it holds nothing but what the destructor frees.
class PngDecoder final : public Decoder {
 public:
  using Decoder::Decoder;
  ~PngDecoder() override { png_destroy_read_struct(&png_, &info_, nullptr); }

  Rgba8Image decode() override {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png_ == nullptr || (info_ = png_create_info_struct(png_)) == nullptr) {
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, this, on_read);
    png_read_info(png_, info_);
    auto rgba = room_for(png_get_image_width(png_, info_), png_get_image_height(png_, info_));
    // To 8 bits, RGBA; the file's own gamma and profile are left aside, as glTF asks.
    png_set_expand(png_);
    png_set_scale_16(png_);
    png_set_gray_to_rgb(png_);
    png_set_add_alpha(png_, 255, PNG_FILLER_AFTER);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    const std::size_t row_bytes = png_get_rowbytes(png_, info_);
    std::vector<png_bytep> rows(png_get_image_height(png_, info_));
    if (row_bytes * rows.size() != bytes()) fail("is corrupt: its rows have another length");
    for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = rgba.get() + y * row_bytes;
    png_read_image(png_, rows.data());
    png_read_end(png_, nullptr);
    return whole(rgba);
  }

 private:
  [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
    static_cast<PngDecoder*>(png_get_error_ptr(png))->fail(std::string("is corrupt: ") + message);
  }
  static void on_warning(png_structp, png_const_charp) {}
  static void on_read(png_structp png, png_bytep to, std::size_t n) {
    auto& rest = static_cast<PngDecoder*>(png_get_io_ptr(png))->encoded_;
    if (n > rest.size()) png_error(png, "it ends early");
    std::memcpy(to, rest.data(), n);
    rest = rest.subspan(n);
  }

  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

/// By libjpeg-turbo, which fills what a cut file lacks with grey and only warns: a warning is an
/// error here.
class JpegDecoder final : public Decoder {
 public:
  using Decoder::Decoder;
  ~JpegDecoder() override { tjDestroy(jpeg_); }

  Rgba8Image decode() override {
    if (jpeg_ == nullptr) throw std::bad_alloc();
    int width = 0, height = 0, subsampling = 0, colours = 0;
    if (tjDecompressHeader3(jpeg_, encoded_.data(), encoded_.size(), &width, &height, &subsampling,
                            &colours) != 0) {
      fail(std::string("is corrupt: ") + tjGetErrorStr2(jpeg_));
    }
    if (colours == TJCS_CMYK || colours == TJCS_YCCK) {
      fail("is a CMYK JPEG; allowed: grey and RGB");
    }
    auto rgba = room_for(width, height);
    constexpr int flags = TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS | TJFLAG_ACCURATEDCT;
    if (tjDecompress2(jpeg_, encoded_.data(), encoded_.size(), rgba.get(), width, 0, height,
                      TJPF_RGBA, flags) != 0) {
      fail(std::string("is corrupt: ") + tjGetErrorStr2(jpeg_));
    }
    return whole(rgba);
  }

 private:
  tjhandle jpeg_ = tjInitDecompress();
};

}  // namespace

Rgba8Image decode_png_or_jpeg(std::span<const std::uint8_t> encoded, const std::string& label) {
  constexpr std::array<std::uint8_t, 8> png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  constexpr std::array<std::uint8_t, 3> jpeg{0xFF, 0xD8, 0xFF};
  const auto starts_with = [&encoded](const auto& magic) {
    return encoded.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), encoded.begin());
  };
  if (starts_with(png)) return PngDecoder(encoded, label).decode();
  if (starts_with(jpeg)) return JpegDecoder(encoded, label).decode();
  throw SceneError(label + ": neither a PNG nor a JPEG");
}

}  // namespace lacuna
