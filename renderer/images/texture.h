#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "renderer/core/huge_pages.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// RGBA, linear after decoding.
struct Rgba {
  Rgb rgb{1, 1, 1};
  float a = 1;
};

/// A texture of a scene. Holds the encoded bytes of its image until decode(), then the texels.
class Texture {
 public:
  enum class Encoding { linear, srgb };
  enum class Wrap { repeat, mirrored, clamp };

  /// `label` names the image in errors. `encoded` holds a whole PNG, JPEG, WebP or TIFF.
  Texture(std::string label, std::vector<std::uint8_t> encoded, Encoding encoding, Wrap wrap_s,
          Wrap wrap_t);

  /// Decodes the image and frees its encoded bytes; no effect if it is decoded. Not thread-safe on
  /// one texture. The scene calls it before rendering, for the textures that the integrator needs.
  /// Texels have 8 bits per channel (16-bit PNGs are rounded), grey becomes RGB, missing alpha
  /// becomes 1, and alpha is not multiplied into the colour. Throws SceneError if the image is not
  /// one of these, is corrupt, or is larger than 16384 x 16384.
  void decode();
  /// The number of texels; before decode(), from the image's header. Throws SceneError.
  std::uint64_t texels() const;
  bool decoded() const { return !texels_.empty(); }
  const std::string& label() const { return label_; }
  std::size_t bytes() const { return texels_.size(); }  ///< decoded memory

  /// Bilinear in linear light; (0, 0) is the upper left corner of the image, as in glTF. Any `uv`
  /// is safe: a non-finite one gives the texel at that corner. Must be decoded.
  Rgba lookup(const V2f& uv) const;
  /// Prefetches the texels that lookup(uv) reads.
  void prefetch(const V2f& uv) const;

  V2i size() const { return {width_, height_}; }  ///< texels; (0, 0) before decode()
  Wrap wrap_s() const { return wrap_s_; }
  Wrap wrap_t() const { return wrap_t_; }
  /// The linear colour of a texel. Must be decoded.
  Rgb texel(const V2i& at) const {
    const std::uint8_t* p = stored(at);
    return {to_linear_[p[0]], to_linear_[p[1]], to_linear_[p[2]]};
  }
  /// The alpha of a texel, from 0 to 255. Must be decoded.
  int alpha(const V2i& at) const { return stored(at)[3]; }

 private:
  struct Footprint;
  const std::uint8_t* stored(const V2i& at) const {
    return &texels_[(static_cast<std::size_t>(at.y) * static_cast<std::size_t>(width_) +
                     static_cast<std::size_t>(at.x)) *
                    4];
  }
  Footprint footprint(const V2f& uv) const;

  std::string label_;
  std::vector<std::uint8_t> encoded_;
  const float* to_linear_;  ///< linear value of each byte under the encoding
  Wrap wrap_s_, wrap_t_;
  int width_ = 0, height_ = 0;
  HugeVector<std::uint8_t> texels_;  ///< RGBA8 as stored in the file
};

}  // namespace lacuna
