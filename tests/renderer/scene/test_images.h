#pragma once

#include <OpenImageIO/imageio.h>

#include <string>
#include <vector>

#include "tests/renderer/scene/glb_builder.h"

namespace lacuna::test {

/// Writes an image through OpenImageIO; `spec` says size, channels and type of `pixels`.
template <class T>
std::filesystem::path write_image(const TemporaryFolder& folder, const std::string& name,
                                  OIIO::ImageSpec spec, const std::vector<T>& pixels) {
  auto file = folder.path() / name;
  const auto out = OIIO::ImageOutput::create(file.string());
  spec.attribute("oiio:UnassociatedAlpha", 1);
  if (!out || !out->open(file.string(), spec) ||
      !out->write_image(OIIO::BaseTypeFromC<T>::value, pixels.data()) || !out->close()) {
    throw std::runtime_error("cannot write " + file.string());
  }
  return file;
}

inline Bytes read_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(stream), {});
}

/// The bytes of a PNG or JPEG (by `format`) with 8 bits a channel.
inline Bytes encode8(int width, int height, int channels, const std::vector<std::uint8_t>& pixels,
                     const std::string& format = "png") {
  const TemporaryFolder folder;
  return read_bytes(write_image(folder, "image." + format,
                                OIIO::ImageSpec(width, height, channels, OIIO::TypeDesc::UINT8),
                                pixels));
}

}  // namespace lacuna::test
