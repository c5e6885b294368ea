#include "renderer/images/png_write.h"

#include <stdexcept>

#include "renderer/images/image_module.h"

namespace lacuna {

std::string encode_png(int width, int height, std::span<const std::uint8_t> values) {
  const ImageCodec& codec = image_codec();
  try {
    const EncodedImage bytes = codec.encode_png(width, height, values);
    return {bytes.begin(), bytes.end()};
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(std::string("cannot encode a PNG: ") + e.what());
  }
}

}  // namespace lacuna
