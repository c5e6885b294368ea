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

/// An image of a scene: its encoded bytes until it is decoded.
class Texture {
 public:
  enum class Encoding { linear, srgb };
  enum class Wrap { repeat, mirrored, clamp };

  /// `label` names the image in errors. `encoded` holds a whole PNG or JPEG file.
  Texture(std::string label, std::vector<std::uint8_t> encoded, Encoding encoding, Wrap wrap_s,
          Wrap wrap_t);

  /// Decodes and frees the encoded bytes; does nothing the second time. Not thread-safe on one
  /// texture: the scene calls it before rendering, for just the textures that the integrator needs.
  /// Kept at 8 bits a channel (PNGs of 16 bits are rounded); grey becomes RGB; no alpha becomes 1;
  /// alpha is never multiplied into the colour. Throws SceneError: not a PNG or JPEG, corrupt, or
  /// larger than 16384 x 16384.
  void decode();
  /// How many it has, decoded or not: then its head says so. Throws SceneError.
  std::uint64_t texels() const;
  bool decoded() const { return !texels_.empty(); }
  const std::string& label() const { return label_; }
  std::size_t bytes() const { return texels_.size(); }  ///< of decoded memory

  /// Bilinear in linear light; (0, 0) is the upper left corner of the image, as in glTF. Any `uv`
  /// is safe: where it is not finite, the texel at that corner. Must be decoded.
  Rgba lookup(const V2f& uv) const;
  /// Prefetches the texels that lookup(uv) reads.
  void prefetch(const V2f& uv) const;

  /// Linear mean over all texels, for estimates of emitter power. Must be decoded.
  Rgba mean() const;

 private:
  struct Footprint;
  Footprint footprint(const V2f& uv) const;

  std::string label_;
  std::vector<std::uint8_t> encoded_;
  const float* to_linear_;  ///< linear value of each byte under the encoding
  Wrap wrap_s_, wrap_t_;
  int width_ = 0, height_ = 0;
  HugeVector<std::uint8_t> texels_;  ///< RGBA8 as stored in the file
};

}  // namespace lacuna
