#pragma once

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <png.h>
#include <turbojpeg.h>

#include <string>
#include <vector>

#include "tests/renderer/scene/glb_builder.h"

namespace lacuna::test {

inline Bytes read_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(stream), {});
}

/// Writes an EXR of 32-bit channels; `pixels` interleaved in their order. `display` is as large as
/// the picture unless told.
inline std::filesystem::path write_exr_file(const TemporaryFolder& folder, const std::string& name,
                                            const std::vector<std::string>& channels,
                                            const std::vector<float>& pixels, int width, int height,
                                            Imath::V2i display = Imath::V2i(0)) {
  const Imath::Box2i data({0, 0}, {width - 1, height - 1});
  Imf::Header header(display.x > 0 ? Imath::Box2i({0, 0}, display - Imath::V2i(1)) : data, data);
  Imf::FrameBuffer frame;
  std::vector<float> copy = pixels;
  const std::size_t stride = channels.size() * sizeof(float);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    header.channels().insert(channels[c], Imf::Channel(Imf::FLOAT));
    frame.insert(channels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(copy.data() + c),
                                         stride, stride * static_cast<std::size_t>(width)));
  }
  auto file = folder.path() / name;
  Imf::OutputFile out(file.c_str(), header);
  out.setFrameBuffer(frame);
  out.writePixels(height);
  return file;
}

/// The bytes of a PNG; `format` as libpng's simplified interface names it.
inline Bytes encode_png(int width, int height, png_uint_32 format, const void* pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = format;
  Bytes bytes(PNG_IMAGE_PNG_SIZE_MAX(image));
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels, 0, nullptr) == 0) {
    throw std::runtime_error(image.message);
  }
  bytes.resize(size);
  return bytes;
}

/// The bytes of a PNG with 8 bits a channel: grey, grey and alpha, RGB or RGBA.
inline Bytes encode8(int width, int height, int channels, const std::vector<std::uint8_t>& pixels) {
  const png_uint_32 formats[] = {PNG_FORMAT_GRAY, PNG_FORMAT_GA, PNG_FORMAT_RGB, PNG_FORMAT_RGBA};
  return encode_png(width, height, formats[channels - 1], pixels.data());
}

/// The bytes of an RGB JPEG.
inline Bytes encode_jpeg(int width, int height, const std::vector<std::uint8_t>& pixels) {
  const tjhandle jpeg = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int failed = tjCompress2(jpeg, pixels.data(), width, 0, height, TJPF_RGB, &bytes, &size,
                                 TJSAMP_444, 95, 0);
  Bytes file(bytes, bytes + (failed == 0 ? size : 0));
  tjFree(bytes);
  tjDestroy(jpeg);
  if (failed != 0) throw std::runtime_error("no JPEG was made");
  return file;
}

}  // namespace lacuna::test
