#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace lacuna {

// The interface of the image module. `module/openimageio.cpp` implements it, `image_module.h` loads
// it, and only this folder calls it, after its own validation. All functions throw
// std::runtime_error with a reason that names no file, and std::bad_alloc.

/// The supported formats. The caller determines the format; the module never guesses it.
enum class ImageFormat { openexr, png, jpeg, webp, radiance_hdr, tiff };

/// The header of one picture of a file, as stored.
struct PictureHeader {
  int width = 0, height = 0;                 ///< stored pixels
  bool cropped = false;                      ///< only a part of a larger picture is stored
  int orientation = 1;                       ///< as in TIFF; 1: top row first, left to right
  std::vector<std::string> channels;         ///< names, e.g. "R", "even.G"
  std::map<std::string, std::string> texts;  ///< text attributes
};

/// An open file. Not thread-safe.
class PictureFile {
 public:
  virtual ~PictureFile() = default;
  virtual const std::vector<PictureHeader>& parts() const = 0;
  /// Reads `channels` (indices into the header's) of all pixels to `out`: interleaved, top row
  /// first, width x height x channels.size() values. Half and unsigned integer values are converted
  /// to float, nothing else is changed.
  virtual void read(std::size_t part, std::span<const int> channels, float* out) = 0;
};

/// An image of integers as stored: alpha not multiplied in, no colour conversion.
struct StoredTexels {
  int width = 0, height = 0;
  int channels = 0;                        ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA
  int bits = 0;                            ///< per value: 8 or 16, in native byte order
  std::unique_ptr<std::uint8_t[]> values;  ///< interleaved, top row first
};

/// Neighbouring rows of an image.
struct RowBlock {
  int first = 0, count = 0;
};

/// The content of an EXR file to write.
struct ExrContent {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  bool half = false;  ///< the type of all values: half, or float
  /// Returns the values of some rows, interleaved in the order of `channels`, valid until the next
  /// call. Called for blocks of rows from the top. encode_exr() passes on its exceptions.
  std::function<const void*(const RowBlock&)> rows;
  std::map<std::string, std::string> texts;  ///< attributes
};

using EncodedImage = std::vector<std::uint8_t>;

class ImageCodec {
 public:
  virtual ~ImageCodec() = default;
  /// Opens a file in memory with the reader of `format`; `bytes` must outlive the result.
  virtual std::unique_ptr<PictureFile> open(ImageFormat format,
                                            std::span<const std::uint8_t> bytes) const = 0;
  /// Decodes a PNG, JPEG, WebP or TIFF of integers. Thread-safe.
  virtual StoredTexels decode(ImageFormat format, std::span<const std::uint8_t> bytes) const = 0;
  /// Scan lines in ZIP compression; equal contents give equal bytes.
  virtual EncodedImage encode_exr(const ExrContent& content) const = 0;
  /// `values`: codes, interleaved, top row first: 3 x width x height of RGB, or 4 x width x height
  /// of RGBA, alpha not multiplied in.
  virtual EncodedImage encode_png(int width, int height,
                                  std::span<const std::uint8_t> values) const = 0;
};

/// The name and type of the module's exported function: it returns the codec, which is never
/// destroyed.
constexpr const char* image_codec_symbol = "lacuna_image_codec";
using ImageCodecFunction = const ImageCodec* (*)();

}  // namespace lacuna
