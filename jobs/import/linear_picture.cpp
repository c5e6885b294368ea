#include "jobs/import/linear_picture.h"

#include <algorithm>
#include <cmath>

#include "base/storage/input_file.h"
#include "jobs/import/tga_picture.h"
#include "renderer/core/scene_error.h"
#include "renderer/film/preview.h"
#include "renderer/images/guards.h"
#include "renderer/images/image_read.h"
#include "renderer/images/png_write.h"
#include "renderer/images/texture.h"

namespace lacuna {
namespace {

LinearPicture blank(int width, int height) {
  LinearPicture picture{width, height, {}};
  picture.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  return picture;
}

template <class F>
LinearPicture filled(int width, int height, F&& pixel) {
  LinearPicture picture = blank(width, height);
  auto out = picture.pixels.begin();
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) *out++ = pixel(x, y);
  }
  return picture;
}

LinearPicture checkerboard(const ImportedTexture& t) {
  constexpr int side = 512;
  return filled(side, side, [&](int x, int y) {
    const bool left = x < side / 2, lower = y >= side / 2;
    return left == lower ? t.even : t.odd;
  });
}

/// The ending of a name, in lower case.
std::string kind_of(const std::filesystem::path& file) {
  std::string kind = file.extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return kind;
}

InputBytes bytes_of(const ImportedTexture& t) {
  InputFile about;
  try {
    return read_input(t.file, max_encoded_bytes, about);
  } catch (const std::logic_error& e) {
    throw SceneError(t.place + ": " + t.file.string() + ": " + e.what());
  }
}

float one_channel(const Rgb& rgb, int channel) { return rgb[std::min(channel, 2)]; }

LinearPicture float_picture(const ImportedTexture& t) {
  const FloatImage image = read_float_image(t.file);
  require_finite(image, t.file.string());
  if (t.channel == 3) {
    throw SceneError(t.place + ": the alpha of an EXR is not read: " + t.file.string());
  }
  return filled(image.width, image.height, [&](int x, int y) {
    const Rgb rgb = image.at(x, y);
    return t.channel ? Rgb(one_channel(rgb, *t.channel)) : rgb;
  });
}

LinearPicture byte_picture(const ImportedTexture& t) {
  InputBytes bytes = bytes_of(t);
  if (kind_of(t.file) == ".tga") {
    const CodePicture codes = read_tga(bytes, t.file.string());
    const std::string png = encode_png(codes.width, codes.height, codes.codes);
    bytes.assign(png.begin(), png.end());
  }
  const bool srgb = t.srgb && t.channel != 3;
  Texture texture(t.file.string(), std::move(bytes),
                  srgb ? Texture::Encoding::srgb : Texture::Encoding::linear, Texture::Wrap::repeat,
                  Texture::Wrap::repeat);
  texture.decode();
  const V2i size = texture.size();
  return filled(size.x, size.y, [&](int x, int y) {
    if (t.channel == 3) {
      return Rgb(texture
                     .lookup({(static_cast<float>(x) + .5F) / static_cast<float>(size.x),
                              (static_cast<float>(y) + .5F) / static_cast<float>(size.y)})
                     .a);
    }
    Rgb rgb = texture.texel({x, y});
    if (!srgb && t.gamma != 1) {
      for (int c = 0; c < 3; ++c) rgb[c] = static_cast<float>(std::pow(double(rgb[c]), t.gamma));
    }
    return t.channel ? Rgb(one_channel(rgb, *t.channel)) : rgb;
  });
}

template <class F>
std::vector<std::uint8_t> codes_of(const LinearPicture& picture, F&& code) {
  std::vector<std::uint8_t> codes;
  codes.reserve(3 * picture.pixels.size());
  for (const Rgb& p : picture.pixels) {
    for (int c = 0; c < 3; ++c) codes.push_back(code(double(p[c])));
  }
  return codes;
}

}  // namespace

bool is_float_picture(const std::filesystem::path& file) {
  const std::string kind = kind_of(file);
  return kind == ".exr" || kind == ".hdr" || kind == ".rgbe" || kind == ".pic" || kind == ".pfm";
}

LinearPicture linear_picture(const ImportedTexture& texture) {
  if (texture.file.empty()) return checkerboard(texture);
  LinearPicture picture =
      is_float_picture(texture.file) ? float_picture(texture) : byte_picture(texture);
  if (texture.inverted) {
    for (Rgb& p : picture.pixels) p = Rgb(1) - p;
  }
  return picture;
}

LinearPicture resized(const LinearPicture& picture, int width, int height) {
  const auto wrapped = [](int i, int n) { return (i % n + n) % n; };
  return filled(width, height, [&](int x, int y) {
    const double u = (x + .5) / width * picture.width - .5,
                 v = (y + .5) / height * picture.height - .5;
    const int x0 = static_cast<int>(std::floor(u)), y0 = static_cast<int>(std::floor(v));
    const auto fx = static_cast<float>(u - x0), fy = static_cast<float>(v - y0);
    const auto at = [&](int i, int j) {
      return picture.at(wrapped(x0 + i, picture.width), wrapped(y0 + j, picture.height));
    };
    return (at(0, 0) * (1 - fx) + at(1, 0) * fx) * (1 - fy) +
           (at(0, 1) * (1 - fx) + at(1, 1) * fx) * fy;
  });
}

std::vector<std::uint8_t> srgb_codes(const LinearPicture& picture, double scale) {
  return codes_of(picture, [scale](double v) { return display_code(v / scale); });
}

std::vector<std::uint8_t> linear_codes(const LinearPicture& picture) {
  return codes_of(picture, [](double v) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 1.0) * 255));
  });
}

}  // namespace lacuna
